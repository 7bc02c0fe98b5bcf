// The trade-off between servo and regulation that an entry carries: on the plant, and on the first-order model.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "engine/controller/pid.h"
#include "engine/evaluation/evaluate.h"
#include "engine/plant/plant_model.h"
#include "engine/tuning/arrieta/arrieta_report.h"
#include "engine/tuning/arrieta/tradeoff.h"

namespace tunewright {

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

struct TradeoffEntry {
    std::optional<Plant> fopdt;            ///< the first-order model, where there is one
    std::optional<std::string> constants;  ///< of the methods arrieta_*: where the rule's constants come from
    std::optional<double> Ms_design;       ///< likewise: the Ms of Table 1's column or of Eq. 9
    TradeoffFigures model;                 ///< on `fopdt`
    TradeoffFigures plant;                 ///< on the (nominal) plant, against the model's reference controllers
    std::optional<TradeoffProfile> profile;
};

/// The plant that figures are about; empty for measured points.
std::optional<Plant> nominal_plant(const PlantModel& plant);

/// Computes entries of one request; what a model asks for once is kept. Not for several threads at once.
class Tradeoffs {
public:
    /// `nominal` is valid (LinearPlant::make); empty: the plant is known by measured points alone, and nothing is told.
    /// The steps of a nonlinear controller's responses are those of `options`, the indices per unit of them.
    explicit Tradeoffs(std::optional<Plant> nominal, const EvaluateOptions& options = {});

    /// `reduced_model`: that the controller was tuned on, if it is of first order; else the plant's own form or its
    /// reduction is taken.
    TradeoffEntry of(const Controller& controller, const std::optional<Plant>& reduced_model);

    /// Of a controller that a servo/regulation rule gave.
    TradeoffEntry of_rule(const Controller& controller, const ArrietaReport& report);

private:
    struct OnModel {
        Expected<ReferenceControllers> references;
        TradeoffScale on_model, on_plant;
    };

    const OnModel& scales(const Fopdt& model);
    TradeoffEntry against(const Fopdt& model, const Controller& controller);
    Expected<Fopdt> model_for(const std::optional<Plant>& reduced_model) const;

    TradeoffFigures figures(const TradeoffScale& scale, const Plant& plant, const Controller& controller) const;

    std::optional<Plant> nominal_;
    EvaluateOptions steps_;
    std::optional<LinearPlant> linear_;
    std::map<std::array<double, 3>, OnModel> kept_;  // by K, T, L
};

/// Warns where the level of Table 2 misses its degradation on the model by more than 0.03.
std::optional<Warning> missed_degradation(const ArrietaReport& report, const TradeoffEntry& entry);

}  // namespace tunewright
