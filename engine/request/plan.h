// The rows that a request's list of methods gives; for method "all" the rows of a comparison of every method.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/error.h"
#include "engine/expected.h"
#include "engine/request/entry.h"
#include "engine/tuning/method/method.h"
#include "engine/tuning/method/options.h"
#include "engine/tuning/registry.h"

namespace tunewright {

struct MethodRequest {
    std::string method =
        default_method();  ///< or "all": every method in all its variants, each with those given options that it has
    MethodOptions options;

    bool of_all() const { return method == "all"; }
};

/// One planned row of the answer: a method with its options, or the reason for which it has none.
struct PlannedRow {
    const TuningMethod* method = nullptr;
    MethodOptions options;
    std::string variant;           ///< in "all": the name of the method's variant in this row
    std::optional<Error> refusal;  ///< error of an option that the method cannot use (unsupported)
    std::string where;             ///< place in the request, "tune/2"
    bool of_all = false;
    bool Ms_asked = true;  ///< false: the limit on Ms is only that of the variant

    /// The method's title with its variant and whatever else distinguishes entries: "Robust optimum (PI, region)".
    std::string title(const std::string& besides = "") const;
};

/// The rows in the request's order, "all" expanded. Error: invalid_argument for an unknown method.
Expected<std::vector<PlannedRow>> plan_rows(const std::vector<MethodRequest>& requests);

/// Every method's variants (method.h), in the registry's order. Each takes those of the `given` options that it has; a
/// variant that contradicts one of them is left out. A method with no variant left has one row with its refusal.
std::vector<PlannedRow> comparison_rows(const MethodOptions& given);

/// The error of an answer whose entries all have an error; a reason that several methods share is stated once.
Error all_failed(const std::vector<TuningEntry>& entries);

}  // namespace tunewright
