// Method "all": which rows a comparison of every method has, and in which order its entries rank.
#pragma once

#include <vector>

#include "engine/evaluation/evaluation.h"
#include "engine/request/plan.h"
#include "engine/tuning/method/options.h"

namespace tunewright {

/// Every method's variants (method.h), in the registry's order. Each takes those of the `given` options that it knows;
/// a variant that contradicts one is left out, a method of which nothing remains is one row with its refusal.
std::vector<PlannedRow> league_rows(const MethodOptions& given);

/// Whether `a` comes before `b`: stable with Ms <= rank_Ms (on the worst plant of a region) first, then stable, then
/// the rest, each by load IAE.
bool outranks(const Evaluation& a, const Evaluation& b, double rank_Ms);

}  // namespace tunewright
