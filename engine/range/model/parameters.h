// A plant between two plants of the same structure: defines the interpolation `parameters`.
#pragma once

#include <string>
#include <vector>

#include "engine/expected.h"
#include "engine/plant/plant.h"

namespace tunewright::range {

/// The numbers that make a plant of its type, in a fixed order: K, T, ... L, or the coefficients of num and den, then
/// L. Sopdt's time constants in descending order. Empty for zeros and poles and for state spaces, whose entries cannot
/// be interpolated.
std::vector<double> structure_numbers(const Plant& plant);

/// True for the same type with the same number of coefficients; false for a type without structure numbers, for which
/// the frequency response is interpolated instead.
bool same_structure(const Plant& one, const Plant& other);

/// The plant whose numbers are interpolated between `left` and `right` (`share` from 0 to 1): the logarithms are
/// linear, or the numbers themselves if their signs differ or one is 0. The two must have the same structure. The
/// result has no uncertainty of its own.
Plant plant_between(const Plant& left, const Plant& right, double share);

/// Position of a family's member relative to its nominal plant: ln of the ratio of each number, 0 if there is no ratio.
std::vector<double> log_ratios(const Plant& nominal, const Plant& member);

/// `plant` with each number multiplied by exp of these ratios: transfers a member's deviation from its nominal plant. A
/// negative dead time becomes 0.
Plant moved_by(const Plant& plant, const std::vector<double>& log_ratios);

}  // namespace tunewright::range
