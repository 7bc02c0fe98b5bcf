// One row of a tuning answer: a planned method's controller with its evaluation and findings.
#pragma once

#include <list>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "engine/identification/identify.h"
#include "engine/plant/analysed_plant.h"
#include "engine/progress.h"
#include "engine/request/entry.h"
#include "engine/request/plan.h"
#include "engine/request/tune.h"
#include "engine/tuning/arrieta/tradeoff_report.h"
#include "engine/tuning/method/setpoint.h"

namespace tunewright {

/// The entries of one planned row.
struct MadeRow {
    std::vector<TuningEntry> entries;  ///< one, or two where a design on the record's region comes first
    bool partial = false;              ///< stopped before its search had finished
    bool cancelled() const;            ///< stopped before there was a design
};

/// Moves an error's place into the request: an option lies below the method's place, `where`; a field of the plant
/// exists only if the request has a plant.
Error placed(const TuningRequest& request, Error error, const std::string& where);

/// Makes the rows of one request; several threads may call it at once. Its arguments must outlive it.
class Rows {
public:
    /// `subject`: the plant that every controller is evaluated on. `problem`: the input of the methods, empty if the
    /// plant is known by points alone. `model`: the record's, null without a record.
    Rows(const TuningRequest& request, const AnalysedPlant& subject, const std::optional<TuningProblem>& problem,
         const IdentifiedModel* model);

    MadeRow of(const PlannedRow& planned, const RunControl& control);
    /// The entry of the request's given controller with this index.
    TuningEntry given(std::size_t index, const RunControl& control);
    /// The entry of today's settings; the request must have them.
    TuningEntry baseline(const RunControl& control);

private:
    /// Several rules may give the same controller: it is evaluated once.
    struct Evaluated {
        explicit Evaluated(const IdealPid& controller) : pid(controller) {}
        IdealPid pid;
        std::once_flag once;
        Expected<Evaluation> evaluation = Error{};
    };

    TuningEntry entry(const PlannedRow& planned, const std::optional<TuningProblem>& problem, const RunControl& control,
                      bool& partial);
    Expected<TunedController> tuned_with(const PlannedRow& planned, const std::optional<TuningProblem>& problem,
                                         const SetpointOptions& setpoint, const RunControl& control,
                                         std::optional<device::Fitted>& fitted) const;
    Expected<Evaluation> evaluated(const Controller& controller);
    void evaluate_into(TuningEntry& entry, const Controller& controller, std::vector<Warning> warnings);
    void add_reports(TuningEntry& entry, std::shared_ptr<MethodReport> own);
    void add_device_entry(TuningEntry& entry, std::optional<device::Fitted> fitted, const RunControl& control) const;
    void judge_given(const GivenController& given, const std::string& where, bool as_design, const RunControl& control,
                     TuningEntry& entry);
    void add_to_design(const RunControl& control, TuningEntry& entry) const;

    const TuningRequest& request_;
    const AnalysedPlant& subject_;
    const std::optional<TuningProblem>& problem_;
    const IdentifiedModel* model_;
    std::mutex lock_;  // protects the members below
    std::list<Evaluated> evaluated_;
    std::mutex tradeoffs_lock_;
    std::optional<Tradeoffs> tradeoffs_;  // made at the first request for it
};

}  // namespace tunewright
