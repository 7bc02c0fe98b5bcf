// A plant between two plants of the same structure: what the interpolation `parameters` means.
#pragma once

#include <string>
#include <vector>

#include "engine/expected.h"
#include "engine/plant/plant.h"

namespace tunewright::range {

/// The numbers that make a plant of its type, in a fixed order: K, T, ... L, or the coefficients of num and den, then
/// L. Sopdt's time constants in descending order. Empty for zeros and poles and for state spaces, whose entries mean
/// nothing between two plants.
std::vector<double> structure_numbers(const Plant& plant);

/// The same type, with the same number of coefficients; false for a type that has no structure numbers, so that a
/// frequency response is what is interpolated there.
bool same_structure(const Plant& one, const Plant& other);

/// The plant whose numbers lie `share` (0 to 1) of the way from `left` to `right`: of the logarithms, of the numbers
/// themselves where their signs differ or one is 0. The two are of the same structure. The plant between has no
/// uncertainty of its own.
Plant plant_between(const Plant& left, const Plant& right, double share);

/// How a member of a family lies off its nominal plant: ln of the ratio of each number, 0 where there is none.
std::vector<double> log_ratios(const Plant& nominal, const Plant& member);

/// `plant` with each number times the ratio of these logarithms: what a member of a family has of its nominal plant.
/// A dead time below 0 is cut off at 0.
Plant moved_by(const Plant& plant, const std::vector<double>& log_ratios);

}  // namespace tunewright::range
