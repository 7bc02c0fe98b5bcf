// One line of an answer: a controller with everything known about it.
#pragma once

#include <optional>
#include <string>

#include "engine/error.h"
#include "engine/evaluation/evaluation.h"
#include "engine/request/as_built.h"
#include "engine/request/optimum_at_ms.h"
#include "engine/tuning/method/method.h"

namespace tunewright {

/// A controller with its evaluation, or why there is none.
struct TuningEntry {
    std::string method;  ///< id; "baseline" for today's settings; empty for controllers that were sent
    std::string title;
    std::string source;
    bool over_region = false;  ///< limits hold over the record's confidence region, not on its model alone
    MethodOptions options;     ///< given, over the defaults
    std::optional<Plant> reduced_model;
    std::optional<double> Ms_limit;            ///< that the method was asked for
    Reports reports;                           ///< of the method, and what was asked for of every controller
    std::optional<OptimumAtMs> optimum_at_Ms;  ///< where asked for
    std::optional<AsBuilt> as_built;           ///< where asked for and possible
    /// The longest sample time of a program with backward rules that keeps Ms within 5 %; of designs.
    std::optional<Figure> longest_sample_time;
    std::optional<Evaluation> evaluation;  ///< warnings of the method come first in its list
    std::optional<Error> error;

    /// The report of this type; null if there is none.
    template <class Report>
    const Report* report_as() const {
        return report_among<Report>(reports);
    }
};

}  // namespace tunewright
