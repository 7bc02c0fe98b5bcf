#include "engine/structure/loop_design.h"

#include <algorithm>
#include <complex>
#include <utility>
#include <vector>

#include "engine/blocks/block_diagram.h"
#include "engine/tuning/robust/robust.h"

namespace tunewright::structure {

namespace {

/// An error of the method robust, where the design of a loop has its place.
Error of_loop(Error error) {
    if (error.kind == ErrorKind::unbounded_optimum) {
        error.message =
            "This plant has no dead time, so the gain is unbounded within the limits. Give the plant its dead time, "
            "or a lag of the measurement, such as the sampling time.";
        error.where = "plant";
    } else if (error.where == "Ms" || error.where == "Mt" || error.where == "controller") {
        error.where = "tune/" + error.where;
    } else if (error.kind == ErrorKind::no_feasible_controller) {
        error.where = "tune";
    } else if (error.kind != ErrorKind::cancelled && !error.where.starts_with("plant")) {
        error.where = "plant";
    }
    return error;
}

}  // namespace

Expected<IdealPid> robust_settings(const LinearPlant& plant, const LoopDesign& design, const RunControl& control) {
    const TuningProblem problem{.plant = Plant(factors_of(plant)), .linear = plant, .dead_time_std = {}};
    auto tuned = tune_robust(problem, {.controller = design.controller, .Ms = design.Ms, .Mt = design.Mt},
                             {control.stop, nullptr, control.now_ms});
    if (!tuned) return of_loop(tuned.error());
    return tuned->controller;
}

Zpk factors_of(const LinearPlant& plant) {
    Zpk out{.K = plant.gain(),
            .zeros = {plant.zeros().begin(), plant.zeros().end()},
            .poles = {plant.poles().begin(), plant.poles().end()},
            .L = plant.dead_time()};
    for (int i = 0; i < plant.integrators(); ++i) out.poles.emplace_back(0);
    for (int i = 0; i > plant.integrators(); --i) out.zeros.emplace_back(0);
    return out;
}

Zpk factors_of(const LinearPlant& first, const LinearPlant& second) {
    Zpk out = factors_of(first);
    const Zpk other = factors_of(second);
    out.K *= other.K;
    out.L += other.L;
    out.zeros.insert(out.zeros.end(), other.zeros.begin(), other.zeros.end());
    out.poles.insert(out.poles.end(), other.poles.begin(), other.poles.end());
    return out;
}

LinearPlant changed(const LinearPlant& plant, double gain, double dead_time) {
    Zpk out = factors_of(plant);
    out.K *= gain;
    out.L *= dead_time;
    return std::move(*LinearPlant::make(Plant(out)));
}

namespace {

/// The plant times s^n.
LinearPlant without_integrators(const LinearPlant& plant, int n) {
    Zpk out = factors_of(plant);
    for (int i = 0; i < n; ++i) out.poles.erase(std::ranges::find(out.poles, std::complex<double>(0)));
    return std::move(*LinearPlant::make(Plant(out)));
}

}  // namespace

void add_row(BlockDiagram& blocks, const PlantRow& row, int y) {
    int integrating = 0, shared = 0;
    for (const auto& [u, plant] : row)
        if (plant->integrators() > 0) {
            shared = integrating == 0 ? plant->integrators() : std::min(shared, plant->integrators());
            ++integrating;
        }
    if (integrating < 2) shared = 0;
    const int sum = shared > 0 ? blocks.add_signal() : y;
    if (shared > 0)
        blocks.add(sum, y,
                   std::move(*LinearPlant::make(Plant(
                       Zpk{.K = 1, .zeros = {}, .poles = std::vector<std::complex<double>>(std::size_t(shared))}))));
    for (const auto& [u, plant] : row)
        if (shared > 0 && plant->integrators() > 0)
            blocks.add(u, sum, without_integrators(*plant, shared));
        else
            blocks.add(u, y, *plant);
}

}  // namespace tunewright::structure
