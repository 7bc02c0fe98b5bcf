// What a request's list of methods asks for, row by row; for method "all" the rows of a comparison of every method.
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
        default_method();  ///< or "all": every method in all its variants, each with those options it knows
    MethodOptions options;

    bool of_all() const { return method == "all"; }
};

/// One row of the answer to come: a method with its options, or why it has none.
struct PlannedRow {
    const TuningMethod* method = nullptr;
    MethodOptions options;
    std::string variant;           ///< in "all": the method's variant that the row is of, by its name
    std::optional<Error> refusal;  ///< an option that was given does not suit the method (unsupported)
    std::string where;             ///< its place in the request, "tune/2"
    bool of_all = false;
    bool Ms_asked = true;  ///< false: the limit on Ms is a variant's, of a rule that promises nothing

    /// The method's title with its variant and with what else tells entries apart: "Robust optimum (PI, region)".
    std::string title(const std::string& besides = "") const;
};

/// In the request's order, "all" expanded. Errors: invalid_argument for an unknown method or none.
Expected<std::vector<PlannedRow>> plan_rows(const std::vector<MethodRequest>& requests);

/// Every method's variants (method.h), in the registry's order. Each takes those of the `given` options that it knows;
/// a variant that contradicts one is left out; a method without any variant left is one row with its refusal.
std::vector<PlannedRow> comparison_rows(const MethodOptions& given);

/// Why no entry of several has a controller; a reason that several methods share is stated once. All have an error.
Error all_failed(const std::vector<TuningEntry>& entries);

}  // namespace tunewright
