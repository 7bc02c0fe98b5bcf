// What the checks of many loops say together: which oscillate as one, where that begins, which are cascades, and the
// order in which mending them pays.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/check/loop_check.h"

namespace tunewright::check {

/// Loops that oscillate together.
struct Cluster {
    double period = 0;                  ///< s
    std::vector<std::size_t> loops;     ///< the likely source first
    std::optional<std::size_t> source;  ///< empty: none stands out
    std::string why;                    ///< one sentence: why that one, or why none
};

struct CascadePair {
    std::size_t master = 0, slave = 0;
};

/// A loop's place in the work list.
struct Rank {
    std::size_t loop = 0;
    Figure gain;                       ///< decrease of the mean magnitude of the error that mending may bring, y
    Figure share;                      ///< the same as a share of the error, 0 to 1
    Figure money;                      ///< per hour, with the loop's weight
    int effort = 0;                    ///< 1: settings; 2: a test; 3: work on the plant
    std::optional<std::size_t> after;  ///< a loop to mend first, because it disturbs this one
};

/// Loops by their index among the given ones.
struct PlantCheck {
    std::vector<Cluster> clusters;
    std::vector<CascadePair> cascades;
    std::vector<Rank> ranking;  ///< first the one to mend first; every loop once
};

/// `cluster` false: each loop is ranked on its own. Loops without a common time are compared by their spectra alone. A
/// loop that oscillates with the source of its group gets the cause `external`, with that source as evidence: by itself
/// it may look like a sticking valve.
PlantCheck check_plant(std::span<LoopCheck* const> loops, bool cluster = true);

/// What has changed between two checks of one loop, and whether chance explains it.
struct Change {
    Verdict before = Verdict::undetermined, now = Verdict::undetermined;
    Figure variability_ratio = {};  ///< standard deviation of the error, now over before
    Figure likelihood = {};         ///< of so large a change by chance, 0 to 1: two-sided F test of the variances
    bool significant = false;       ///< the likelihood is below kByChance
};

inline constexpr double kByChance = 0.01;

/// The F test takes each record for as many independent values as its error has.
Change change_of(const LoopCheck& before, const LoopCheck& now);

}  // namespace tunewright::check
