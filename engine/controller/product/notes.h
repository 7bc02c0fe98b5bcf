// Notes on the differences between a block and the law that it was set for.
#pragma once

#include <vector>

#include "engine/controller/product/settings.h"

namespace tunewright::product {

/// A conversion in progress: the requested law, the settings, and the law that the block realises.
struct Comparison {
    const Product& product;
    const IdealPid& asked;
    const IdealPid& realised;
    const Context& context;
    const Settings& settings;  ///< in full precision
    const Settings& typed;     ///< in the block's resolution
};

/// Adds a note for each fact to know about the block, whatever its settings were made from: an output in percent, rules
/// of the algorithm, clock, evidence. `realised`: the law of its settings. Codes: percent, discretisation,
/// unstable-filter, clock, unverified.
void add_block_notes(const Product& product, const IdealPid& realised, const Context& context,
                     std::vector<Note>& notes);

/// Adds a note for each difference from the requested law: weights, filter, rounding; then those on the block. Codes:
/// setpoint-weights, prefilter, filter, filter-ratio (of a series block: the settings that have the design's own),
/// rounding.
void add_notes(const Comparison& comparison, std::vector<Note>& notes);

/// The set-point filter before the block that gives exactly the requested weights, as text. "" if there is none: the
/// block has no integral action, or no part of the set point that a proper filter could shape.
///   F(s) = [1 + b Ti s + c Ti s D]/[1 + b' Ti s + c' Ti s D],  D = Td s/(1 + Tf s), b' and c' the block's.
std::string setpoint_prefilter(const IdealPid& asked, const IdealPid& realised);

}  // namespace tunewright::product
