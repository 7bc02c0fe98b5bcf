// Report that one method adds to its result. Each kind is a type in the method's folder; api encodes it by its type.
#pragma once

#include <memory>
#include <vector>

#include "engine/evaluation/evaluation.h"
#include "engine/plant/analysed_plant.h"

namespace tunewright {

class Tradeoffs;

/// The data with which a report is completed, once its controller has been evaluated.
struct ReportContext {
    const AnalysedPlant& subject;
    const EvaluateOptions& options;
    Tradeoffs& tradeoffs;  ///< on the nominal plant; one for the whole request
};

class MethodReport {
public:
    virtual ~MethodReport() = default;

    /// Adds the parts that depend on the plant and on the requested output; remarks are added to the evaluation's
    /// warnings.
    virtual void complete(const ReportContext&, Evaluation&) {}
};

using Reports = std::vector<std::shared_ptr<const MethodReport>>;

/// The report of this type; null if there is none.
template <class Report>
const Report* report_among(const Reports& reports) {
    for (const auto& report : reports)
        if (const auto* found = dynamic_cast<const Report*>(report.get())) return found;
    return nullptr;
}

}  // namespace tunewright
