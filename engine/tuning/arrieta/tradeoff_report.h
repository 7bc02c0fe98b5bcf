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

/// What the servo/regulation rule says of a controller that it gave.
struct ArrietaSettings {
    Fopdt model;                        ///< that the rule worked on
    std::string constants;              ///< where its constants come from: table and column, or equation
    std::optional<double> Ms_design;    ///< of Table 1's column or Eq. 9
    std::optional<double> degradation;  ///< a level of Table 2, which the table may miss
    bool profile = false;               ///< the curves over Ms and over the levels are asked for
};

/// One controller of the servo/regulation rule on the model.
struct ProfilePoint {
    double level = 0;  ///< the Ms that it is designed for, or the allowed degradation
    double Ms = 0, J_r = 0, J_d = 0, J_rd = 0, I_perf = 0, Deg = 0;
};

/// What the rule offers on this model (the source's Figs. 2 to 5). Designs that it has no controller for, or whose loop
/// has no such figures, are left out.
struct TradeoffProfile {
    std::vector<ProfilePoint> by_Ms;           ///< Eq. 9 (c3 refitted), Ms = 1.4, 1.45 ... 2
    std::vector<ProfilePoint> by_degradation;  ///< Table 2, by its levels
};

/// Of a controller that the rule gave, or of any other.
struct TradeoffReport : MethodReport {
    std::optional<ArrietaSettings> rule;

    std::optional<Plant> fopdt;            ///< the first-order model, where there is one
    std::optional<std::string> constants;  ///< of the methods arrieta_*: where the rule's constants come from
    std::optional<double> Ms_design;       ///< likewise: the Ms of Table 1's column or of Eq. 9
    TradeoffFigures model;                 ///< on `fopdt`
    TradeoffFigures plant;                 ///< on the (nominal) plant, against the model's reference controllers
    std::optional<TradeoffProfile> profile;

    TradeoffReport() = default;
    explicit TradeoffReport(ArrietaSettings settings) : rule(std::move(settings)) {}

    /// Warns where the level of Table 2 misses its degradation on the model by more than 0.03.
    void complete(const ReportContext& context, Evaluation& evaluation) override;
};

/// Computes reports of one request; what a model asks for once is kept. Not for several threads at once.
class Tradeoffs {
public:
    /// `nominal` is valid (LinearPlant::make); empty: the plant is known by measured points alone, and every figure is
    /// empty.
    /// The steps of a nonlinear controller's responses are those of `options`, the indices per unit of them.
    explicit Tradeoffs(std::optional<Plant> nominal, const EvaluateOptions& options = {});

    /// `reduced_model`: that the controller was tuned on, if it is of first order; else the plant's own form or its
    /// reduction is taken.
    TradeoffReport of(const Controller& controller, const std::optional<Plant>& reduced_model);

    /// Of a controller that a servo/regulation rule gave.
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
    std::map<std::array<double, 3>, OnModel> kept_;  // by K, T, L
};

}  // namespace tunewright
