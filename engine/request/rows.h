// One row of a tuning answer: a planned method's controller with everything that is said of it.
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

/// A planned row, made.
struct MadeRow {
    std::vector<TuningEntry> entries;  ///< one, or two where a design on the record's region comes first
    bool partial = false;              ///< stopped before its search had ended
    bool cancelled() const;            ///< stopped before there was a design
};

/// Methods name an option or a field of the plant; the request has the one under the method's place, `where`, and the
/// other only if it gave a plant.
Error placed(const TuningRequest& request, Error error, const std::string& where);

/// Makes the rows of one request; several at once, if wanted. What it is made from must outlive it.
class Rows {
public:
    /// `subject`: what every controller is judged on. `problem`: what methods work on, empty where the plant is known
    /// by points alone. `model`: the record's, null where there is none.
    Rows(const TuningRequest& request, const AnalysedPlant& subject, const std::optional<TuningProblem>& problem,
         const IdentifiedModel* model);

    MadeRow of(const PlannedRow& planned, const RunControl& control);
    /// The settings given in the request, which has some.
    TuningEntry baseline(const RunControl& control);

private:
    /// Several rules may give the very same controller: it is evaluated once.
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
    void add_baseline_on_device(TuningEntry& entry, const RunControl& control) const;
    void add_to_design(const PlannedRow& planned, const std::optional<TuningProblem>& problem,
                       const RunControl& control, TuningEntry& entry) const;

    const TuningRequest& request_;
    const AnalysedPlant& subject_;
    const std::optional<TuningProblem>& problem_;
    const IdentifiedModel* model_;
    std::mutex lock_;  // of what follows
    std::list<Evaluated> evaluated_;
    std::mutex tradeoffs_lock_;
    std::optional<Tradeoffs> tradeoffs_;  // made when first asked for
};

}  // namespace tunewright
