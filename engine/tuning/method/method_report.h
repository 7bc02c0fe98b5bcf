// What a method reports beside its controller. Each kind is a type of its own in the method's folder; the interface
// encodes it by its type.
#pragma once

#include <memory>
#include <vector>

#include "engine/evaluation/evaluation.h"
#include "engine/plant/analysed_plant.h"

namespace tunewright {

class Tradeoffs;

/// What a report may be completed from, once its controller has been evaluated.
struct ReportContext {
    const AnalysedPlant& subject;
    const EvaluateOptions& options;
    Tradeoffs& tradeoffs;  ///< on the nominal plant; kept for the whole request
};

class MethodReport {
public:
    virtual ~MethodReport() = default;

    /// Adds what depends on the plant and on what is to be answered; remarks go to the evaluation's warnings.
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
