// Method "all": which rows a comparison of every method has, and in which order its entries rank.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/error.h"
#include "engine/evaluate.h"
#include "engine/tuning/method.h"

namespace tunewright {

/// One row: a method with its options, or why it has none.
struct LeagueRow {
    const TuningMethod* method = nullptr;
    MethodOptions options;
    std::string title;             ///< the method's, with its variant in brackets
    std::optional<Error> refusal;  ///< an option that was given does not suit the method (unsupported)
};

/// Every method's variants (method.h), in the registry's order. Each takes those of the `given` options that it knows;
/// a variant that contradicts one is left out, a method of which nothing remains is one row with its refusal.
std::vector<LeagueRow> league_rows(const MethodOptions& given);

/// Whether `a` comes before `b`: stable with Ms <= rank_Ms first, then stable, then the rest, each by load IAE.
bool outranks(const Evaluation& a, const Evaluation& b, double rank_Ms);

}  // namespace tunewright
