// The trade-off between servo and regulation of a controller: on the plant, and on the first-order model.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "engine/controller/pid.h"
#include "engine/evaluation/evaluation.h"
#include "engine/tuning/arrieta/tradeoff.h"
#include "engine/tuning/method/method_report.h"

namespace tunewright {

/// The report of the servo/regulation rule on its controller.
struct ArrietaSettings {
    Fopdt model;                        ///< the model that the rule used
    std::string constants;              ///< origin of its constants: table and column, or equation
    std::optional<double> Ms_design;    ///< Ms of Table 1's column or of Eq. 9
    std::optional<double> degradation;  ///< a level of Table 2, which the controller may miss
    bool profile = false;               ///< true: the curves over Ms and over the levels are requested
};

/// One controller of the servo/regulation rule on the model.
struct ProfilePoint {
    double level = 0;  ///< the design's Ms, or its allowed degradation
    double Ms = 0, J_r = 0, J_d = 0, J_rd = 0, I_perf = 0, Deg = 0;
};

/// The rule's trade-off on this model (the source's Figs. 2 to 5). Designs without a controller, or without these
/// figures, are omitted.
struct TradeoffProfile {
    std::vector<ProfilePoint> by_Ms;           ///< Eq. 9 (c3 refitted), Ms = 1.4, 1.45 ... 2
    std::vector<ProfilePoint> by_degradation;  ///< Table 2, by its levels
};

/// The trade-off of any controller, whether the rule gave it or not.
struct TradeoffReport : MethodReport {
    std::optional<ArrietaSettings> rule;

    std::optional<Plant> fopdt;            ///< the first-order model, if there is one
    std::optional<std::string> constants;  ///< for the methods arrieta_*: origin of the rule's constants
    std::optional<double> Ms_design;       ///< also for these: the Ms of Table 1's column or of Eq. 9
    TradeoffFigures model;                 ///< on `fopdt`
    TradeoffFigures plant;                 ///< on the (nominal) plant, against the model's reference controllers
    std::optional<TradeoffProfile> profile;

    TradeoffReport() = default;
    explicit TradeoffReport(ArrietaSettings settings) : rule(std::move(settings)) {}

    /// Warns if the degradation on the model differs by more than 0.03 from the level of Table 2.
    void complete(const ReportContext& context, Evaluation& evaluation) override;
};

/// Computes the reports of one request; results for a model are cached. Not thread-safe.
class Tradeoffs {
public:
    /// `nominal` is valid (LinearPlant::make); empty: the plant is known by measured points alone, and every figure is
    /// empty. A nonlinear controller's responses have the steps of `options`, and its indices are per unit of these
    /// steps.
    explicit Tradeoffs(std::optional<Plant> nominal, const EvaluateOptions& options = {});

    /// `reduced_model`: the model for which the controller was tuned, if it is of first order; otherwise the plant's
    /// own form or its reduction is used.
    TradeoffReport of(const Controller& controller, const std::optional<Plant>& reduced_model);

    /// For a controller of a servo/regulation rule.
    TradeoffReport of_rule(const Controller& controller, const ArrietaSettings& settings);

private:
    struct OnModel {
        Expected<ReferenceControllers> references;
        TradeoffScale on_model, on_plant;
    };

    const OnModel& scales(const Fopdt& model);
    TradeoffReport against(const Fopdt& model, const Controller& controller);
    Expected<Fopdt> model_for(const std::optional<Plant>& reduced_model) const;

    TradeoffFigures figures(const TradeoffScale& scale, const Plant& plant, const Controller& controller) const;

    std::optional<Plant> nominal_;
    EvaluateOptions steps_;
    std::optional<LinearPlant> linear_;
    std::map<std::array<double, 3>, OnModel> kept_;  // cached by K, T, L
};

}  // namespace tunewright
