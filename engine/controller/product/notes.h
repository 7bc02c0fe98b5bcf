// What a block does differently from the law that it was set for, in sentences.
#pragma once

#include <vector>

#include "engine/controller/product/settings.h"

namespace tunewright::product {

/// A conversion as far as it has come: the law asked for, what is typed, and what the block then is.
struct Comparison {
    const Product& product;
    const IdealPid& asked;
    const IdealPid& realised;
    const Context& context;
    const Settings& settings;  ///< in full precision
    const Settings& typed;     ///< in the block's resolution
};

/// Weights, filter, rounding, rules of the algorithm, clock, evidence: each that differs or that has to be known, with
/// the codes setpoint-weights, prefilter, filter, filter-ratio (of a series block: the settings that have the design's
/// own), rounding, discretisation, clock, unverified.
void add_notes(const Comparison& comparison, std::vector<Note>& notes);

/// The set-point filter before the block that gives the weights asked for, exactly, as text; "" where there is none:
/// the block has no integral action, or no part of the set point that a proper filter could shape.
///   F(s) = [1 + b Ti s + c Ti s D]/[1 + b' Ti s + c' Ti s D],  D = Td s/(1 + Tf s), b' and c' the block's.
std::string setpoint_prefilter(const IdealPid& asked, const IdealPid& realised);

}  // namespace tunewright::product
