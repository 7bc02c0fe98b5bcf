#include "engine/structure/predictor.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <limits>
#include <memory>
#include <numbers>
#include <utility>

#include "engine/blocks/diagram_loop.h"
#include "engine/loop/peaks.h"
#include "engine/number_text.h"
#include "engine/numerics/optimise/line_search.h"
#include "engine/structure/drawing/view.h"
#include "engine/structure/loop_design.h"
#include "engine/structure/search/local_peaks.h"

namespace tunewright::structure {
namespace {

using Complex = std::complex<double>;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kQuickest = 0.02, kSlowest = 50;        // of L + |T|: lambda and Tf
constexpr double kOfCrossing = 1e-15, kOfKnob = 1e-9;    // relative: where the bisection ends
constexpr double kSlower = 1.1, kOfKnobForPlant = 1e-6;  // ratio of the knobs tried on a plant that is not the model
constexpr int kPerDecade = 400;                          // frequencies at which |S| = |T| is looked for
constexpr double kLow = 1e-3, kHigh = 1e3;               // of 1/L
constexpr double kBesideZero = 1e-5;  // of 1/time scale: the controller's own integrator is left of it

using OverFrequency = std::function<Complex(double)>;

Expected<LinearPlant> block(const Rational& r, double gain = 1, double L = 0) {
    TransferFunction plant{.num = r.num, .den = r.den, .L = L};
    for (double& c : plant.num) c *= gain;
    return LinearPlant::make(Plant(plant));
}

Rational fraction_of(const PredictorModel& m) {
    return m.integrating ? Rational{{m.K}, {1, 0}} : Rational{{m.K}, {m.T, 1}};
}

double scale_of(const PredictorModel& m) { return m.L + (m.integrating ? 0 : std::abs(m.T)); }

/// beta of the filtered predictor.
double zero_of(const PredictorModel& m, double Tf) {
    if (m.integrating) return 2 * Tf + m.L;
    const double share = 1 - Tf / m.T;
    return m.T * (1 - share * share * std::exp(-m.L / m.T));
}

/// T of the design without the dead time's model error.
OverFrequency closed_loop(const PredictorModel& m, PredictorKind kind, double knob) {
    return [=, beta = zero_of(m, knob)](double omega) {
        const Complex s(0, omega), late = std::exp(-m.L * s);
        if (kind != PredictorKind::filtered_smith) return late / (knob * s + 1.0);
        return late * (beta * s + 1.0) / ((knob * s + 1.0) * (knob * s + 1.0));
    };
}

double Ms_of(const PredictorModel& m, const OverFrequency& T) {
    double most = 0;
    for (const LimitedPeak& peak : local_peaks(
             logarithmic(kLow / m.L, kHigh / m.L, 60),
             [&](double omega, std::vector<double>&excess) { excess = {std::log(std::abs(1.0 - T(omega)))}; }, -0.5))
        most = std::max(most, std::exp(peak.excess));
    return most;
}

struct Window {
    double up = kInfinity, down = kInfinity;
};

/// The dead-time errors at which the loop is just not stable: exp(-j omega d) = -S/T where |S| = |T|; the smallest on
/// either side.
Window window_of(const OverFrequency& T, const std::vector<double>& grid) {
    Window out;
    const auto difference = [&](double omega) {
        const Complex t = T(omega);
        return std::abs(1.0 - t) - std::abs(t);
    };
    double before = difference(grid.front());
    for (std::size_t i = 1; i < grid.size(); ++i) {
        const double here = difference(grid[i]);
        if ((before < 0) != (here < 0)) {
            const double low = log_bisect(
                                   {grid[i - 1], grid[i]},
                                   [&](double omega) { return (difference(omega) < 0) == (before < 0); }, kOfCrossing)
                                   .inside;
            const Complex t = T(low);
            double later = -std::arg(-(1.0 - t) / t);
            if (later < 0) later += 2 * std::numbers::pi;
            out.up = std::min(out.up, later / low);
            out.down = std::min(out.down, (2 * std::numbers::pi - later) / low);
        }
        before = here;
    }
    return out;
}

std::vector<double> fine_grid(double L) { return logarithmic(kLow / L, kHigh / L, kPerDecade); }

struct Diagram {
    BlockDiagram blocks;
    int y = 0, u = 0, v = 0, plant_input = 0;  ///< the model sees u, the plant also the load
};

/// `plant` null: the controller by itself.
Expected<Diagram> diagram_of(const LinearPlant* plant, const PredictorController& controller) {
    const PredictorModel& m = controller.model;
    Diagram out;
    out.y = out.blocks.add_signal();
    out.u = out.blocks.add_signal();
    out.v = out.blocks.add_signal();
    const int past = out.blocks.add_signal();  // u less its filtered past
    const auto C = block(controller.C), F = block(controller.F, -1), late = block(controller.F, -1, m.L),
               Gm = block(fraction_of(m), -1);
    for (const auto* part : {&C, &F, &late, &Gm})
        if (!*part) return part->error();
    out.blocks.add(out.v, out.u, *C);
    out.blocks.add(out.u, past, 1);
    out.blocks.add(out.u, past, *late);
    out.blocks.add(past, out.v, *Gm, m.integrating || m.T < 0);
    if (plant == nullptr) return out;
    out.blocks.add(out.y, out.v, *F);
    out.plant_input = out.blocks.add_signal();
    out.blocks.add(out.u, out.plant_input, 1);
    out.blocks.add(out.plant_input, out.y, *plant);
    return out;
}

/// With lambda, Tf or the predictive PI's lag as the knob.
PredictorController controller_of(const PredictorModel& m, PredictorKind kind, double knob) {
    PredictorController out;
    out.model = m;
    out.F = {{1}, {1}};
    const bool filtered = kind == PredictorKind::filtered_smith;
    out.lambda = knob;
    if (m.integrating) {
        // s^2 + Kp K s + Ki K with both roots at -1/lambda.
        out.C = {{2 / (m.K * knob), 1 / (m.K * knob * knob)}, {1, 0}};
    } else if (m.T < 0) {
        out.C = {{(2 * m.T / knob - 1) / m.K, m.T / (m.K * knob * knob)}, {1, 0}};
    } else {
        out.C = {{m.T, 1}, {m.K * knob, 0}};
    }
    if (!filtered) return out;
    out.Tf = knob;
    out.beta = zero_of(m, knob);
    // (beta s + 1)/(Tf s + 1)^2 over T0, whose numerator is that of C where C does not cancel the model's pole.
    const bool kept = m.integrating || m.T < 0;
    out.F = {{out.beta, 1}, {kept ? out.C.num[0] / out.C.num[1] : knob, 1}};
    return out;
}

std::optional<Error> refused(const PredictorModel& m, const PredictorDesign& design) {
    if (!(m.L > 0))
        return Error{ErrorKind::invalid_argument, "model/L",
                     "L is " + text(m.L) + "; a predictor needs a dead time above 0."};
    if (m.K == 0 || !std::isfinite(m.K) || !std::isfinite(m.T) || (!m.integrating && m.T == 0))
        return Error{ErrorKind::invalid_argument, "model", "K and T of the model must be finite numbers other than 0."};
    if (!(design.Ms > 1 && design.Ms <= kMaxPredictorMs))
        return Error{ErrorKind::invalid_argument, "Ms",
                     "Ms is " + text(design.Ms) + "; it must be above 1 and at most " + text(kMaxPredictorMs) +
                         ": no Smith predictor has a peak of 2."};
    if ((m.integrating || m.T < 0) && design.kind != PredictorKind::filtered_smith)
        return Error{ErrorKind::unsupported, "kind",
                     "On an integrating or unstable plant a predictor without filter leaves a lasting error after a "
                     "load, or is not stable. Use filtered_smith."};
    return std::nullopt;
}

/// The smallest knob from `first` on that keeps the limits; empty: none does. Not by bisection over the whole range:
/// beta of a filtered predictor becomes negative far above the lag, and its peak rises again.
template <class Keeps>
std::optional<double> smallest_knob(const PredictorModel& m, double first, double tolerance, const Keeps& keeps) {
    for (double knob = first; knob <= kSlowest * scale_of(m); knob *= kSlower)
        if (keeps(knob)) return knob == first ? knob : log_bisect({knob, knob / kSlower}, keeps, tolerance).inside;
    return std::nullopt;
}

/// With the exact model.
std::optional<double> knob_for_model(const PredictorModel& m, const PredictorDesign& design) {
    return smallest_knob(m, kQuickest * scale_of(m), kOfKnob, [&, grid = fine_grid(m.L)](double knob) {
        const auto T = closed_loop(m, design.kind, knob);
        if (!(Ms_of(m, T) <= design.Ms)) return false;
        if (!design.dead_time_error) return true;
        const Window found = window_of(T, grid);
        return std::min(found.up, found.down) >= *design.dead_time_error * m.L;
    });
}

/// True if the loop with the true plant keeps the limits.
bool keeps_limits(const LinearPlant& plant, const PredictorController& controller, const PredictorDesign& design) {
    const auto diagram = diagram_of(&plant, controller);
    if (!diagram || !count_unstable_poles(diagram->blocks).stable()) return false;
    const DiagramLoop at_plant(diagram->blocks, diagram->y);
    const double Ms = find_sensitivity_peak(at_plant, make_peak_grid(at_plant)).value;
    if (Ms > design.Ms * (1 + limits::kMaxRelativeExcessSearched)) return false;
    if (!design.dead_time_error) return true;
    const Window window = window_of([&](double omega) { return at_plant.at(omega).T; }, fine_grid(controller.model.L));
    const double wanted = *design.dead_time_error * controller.model.L * (1 - limits::kMaxRelativeExcessSearched);
    return window.up >= wanted && window.down >= std::min(wanted, plant.dead_time());
}

struct PidLoop {
    BlockDiagram blocks;
    int y = 0, u = 0, r = 0;
};

Expected<PidLoop> pid_loop(const LinearPlant& plant, const IdealPid& controller) {
    PidLoop out;
    out.y = out.blocks.add_signal();
    const auto pid = add_pid(out.blocks, to_parallel(controller), out.y);
    if (!pid) return pid.error();
    out.u = pid->output;
    out.r = pid->error;
    out.blocks.add(out.u, out.y, plant);
    return out;
}

/// The robust PID with the Ms that the predictor has, which is below the limit where the window of the dead time bounds
/// the design.
void compare_with_pid(const LinearPlant& plant, const RunControl& control, PredictorResult& out) {
    if (!out.figures.stable) {
        out.pid_IAE = no_figure("The predictor is not stable, so there is no Ms for a PID to match.");
        return;
    }
    const double Ms = out.figures.Ms;
    const auto settings = robust_settings(
        plant, {.controller = ControllerKind::PID, .Ms = Ms, .Mt = std::max(Ms, limits::kDefaultMt)}, control);
    if (!settings) {
        out.pid_IAE = no_figure(settings.error().message);
        return;
    }
    out.pid = *settings;
    const auto loop = pid_loop(plant, *settings);
    out.pid_IAE = no_figure("The loop with the PID could not be simulated.");
    if (!loop) return;
    if (const auto figures = step_figures(loop->blocks, loop->u, loop->y, loop->u, 0)) out.pid_IAE = figures->IAE;
}

/// An unstable model is not simulated: it cancels its own past only up to rounding, and what is left grows without
/// bound.
bool runs_away(const PredictorModel& model) { return !model.integrating && model.T < 0; }

/// Figures after unit steps of load and set point.
std::optional<Error> add_responses(const Diagram& diagram, const PredictorModel& model, PredictorFigures& out) {
    if (runs_away(model)) {
        out.load = out.setpoint = OrReason<StepFigures>({}, "Responses are not simulated on an unstable model.");
        return std::nullopt;
    }
    const auto load = step_figures(diagram.blocks, diagram.plant_input, diagram.y, diagram.u, 0);
    if (!load) return load.error();
    out.load = *load;
    const auto setpoint = step_figures(diagram.blocks, diagram.v, diagram.y, diagram.u, 1);
    if (!setpoint) return setpoint.error();
    out.setpoint = *setpoint;
    return std::nullopt;
}

}  // namespace

Expected<PredictorFigures> judge_predictor(const LinearPlant& plant, const PredictorController& controller) {
    const auto diagram = diagram_of(&plant, controller);
    if (!diagram) return diagram.error();
    const auto alone = diagram_of(nullptr, controller);
    PredictorFigures out;
    out.controller_unstable_poles = count_unstable_poles(alone->blocks, kBesideZero).unstable_poles;
    out.stable = count_unstable_poles(diagram->blocks).stable();
    const std::string unstable = "The loop is not stable.";
    out.dead_time_up = out.dead_time_down = no_figure(unstable);
    out.load = out.setpoint = OrReason<StepFigures>({}, unstable);
    if (!out.stable) return out;
    const DiagramLoop at_plant(diagram->blocks, diagram->y);
    const Peaks peaks = find_peaks(at_plant, make_peak_grid(at_plant));
    out.Ms = peaks.S.value;
    out.Mt = peaks.T.value;
    const double L = std::max(plant.dead_time(), 1e-6 * plant.time_scale());
    const Window window = window_of([&](double omega) { return at_plant.at(omega).T; }, fine_grid(L));
    out.dead_time_up =
        std::isfinite(window.up) ? Figure(window.up) : no_figure("No later dead time makes it unstable.");
    out.dead_time_down = std::min(window.down, plant.dead_time());
    if (auto error = add_responses(*diagram, controller.model, out)) return *error;
    return out;
}

std::optional<PredictorModel> model_of(const LinearPlant& plant) {
    if (!plant.zeros().empty()) return std::nullopt;
    const bool integrating = plant.integrators() == 1 && plant.poles().empty();
    if (!integrating && (plant.integrators() != 0 || plant.poles().size() != 1)) return std::nullopt;
    return PredictorModel{.K = plant.low_frequency_gain(),
                          .T = integrating ? 1 : -1 / plant.poles().front().real(),
                          .L = plant.dead_time(),
                          .integrating = integrating};
}

Expected<PredictorResult> design_predictor(const PredictorModel& model, const LinearPlant& plant,
                                           const PredictorDesign& design, const RunControl& control) {
    if (auto error = refused(model, design)) return *error;
    PredictorResult out;
    const bool fixed = design.kind == PredictorKind::predictive_pi;
    auto knob = fixed ? std::optional(model.T) : knob_for_model(model, design);
    if (const auto own = model_of(plant); knob && !fixed && own != model)
        knob = smallest_knob(model, *knob, kOfKnobForPlant, [&](double one) {
            return keeps_limits(plant, controller_of(model, design.kind, one), design);
        });
    if (!knob)
        return Error{ErrorKind::no_feasible_controller, "Ms",
                     "No predictor of this kind and model keeps the limits on the plant; allow a larger Ms, or give a "
                     "model nearer to the plant."};
    out.controller = controller_of(model, design.kind, *knob);
    auto figures = judge_predictor(plant, out.controller);
    if (!figures) return figures.error();
    out.figures = std::move(*figures);
    if (design.dead_time_error && !fixed)
        out.limited_by_dead_time = out.figures.Ms < design.Ms * (1 - limits::kMaxRelativeExcessShown);
    compare_with_pid(plant, control, out);
    return out;
}

Expected<StructureView> predictor_view(const LinearPlant& plant, const PredictorController& controller,
                                       std::optional<double> limit) {
    auto all = diagram_of(&plant, controller);
    if (!all) return all.error();
    const auto blocks = std::make_shared<const BlockDiagram>(all->blocks);
    StructureView out{.of = "design",
                      .diagram = std::move(all->blocks),
                      .inputs = {{"setpoint", all->v}, {"load", all->plant_input}},
                      .outputs = {{"y", all->y}, {"u", all->u}},
                      .curves = {sensitivity_at("loop", blocks, all->y, limit)}};
    if (runs_away(controller.model)) out.inputs.clear();
    return out;
}

Expected<StructureView> pid_view(const LinearPlant& plant, const IdealPid& controller) {
    auto loop = pid_loop(plant, controller);
    if (!loop) return loop.error();
    const auto blocks = std::make_shared<const BlockDiagram>(loop->blocks);
    return StructureView{.of = "pid",
                         .diagram = std::move(loop->blocks),
                         .inputs = {{"setpoint", loop->r}, {"load", loop->u}},
                         .outputs = {{"y", loop->y}, {"u", loop->u}},
                         .curves = {sensitivity_at("loop", blocks, loop->u, {})}};
}

}  // namespace tunewright::structure
