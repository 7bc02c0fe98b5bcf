#include "engine/structure/program/predictor_program.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "engine/code/composer.h"
#include "engine/loop/sampled/held_plant.h"
#include "engine/number_text.h"
#include "engine/numerics/matrix/linear_algebra.h"
#include "engine/simulation/run/held_motion.h"

namespace tunewright::structure {
namespace {

using code::Composer;
using code::DiscreteSystem;
using code::Expr;
using code::Program;
using code::Type;
using code::when;
using code::whole;

constexpr double kPoleTolerance = 1e-3;  // of F at the model's pole: coefficients may be rounded to four digits

Expected<Realisation> realised(const Rational& r) {
    const auto plant = LinearPlant::make(Plant(TransferFunction{.num = r.num, .den = r.den}));
    if (!plant) return plant.error();
    return plant->realisation();
}

/// The system over one call with an input that is held and arrives `rest` after the call begins; what came before acts
/// through Gamma1.
struct HeldSystem {
    HeldSystem(const Realisation& plant, double Ts, double rest) {
        const HeldMotion motion(plant, 1, false);
        const HeldStep whole = motion.step(Ts), after = motion.step(Ts - rest);
        system = {.Phi = whole.Phi, .Gamma = after.Gamma, .C = plant.C, .D = plant.D};
        if (rest == 0) return;
        Gamma1.resize(plant.C.size());
        multiply(after.Phi, motion.step(rest).Gamma, Gamma1);
    }

    DiscreteSystem system;
    std::vector<double> Gamma1;
};

/// (E - F) Gm without the model's pole.
Expected<Rational> without_pole(const PredictorModel& m, const Rational& F) {
    const double pole = m.integrating ? 0 : -1 / m.T, E = std::exp(pole * m.L);
    std::vector<double> dividend(F.den.size(), 0.0);
    double size = 0;
    for (std::size_t i = 0; i < F.den.size(); ++i) {
        const std::size_t missing = F.den.size() - F.num.size();
        dividend[i] = E * F.den[i] - (i < missing ? 0 : F.num[i - missing]);
        size = size * std::abs(pole) + std::abs(E * F.den[i]);
    }
    Rational out{{}, F.den};
    double carried = 0;  // Horner's scheme: the quotient, then the remainder
    for (std::size_t i = 0; i < dividend.size(); ++i) {
        carried = dividend[i] + pole * carried;
        if (i + 1 < dividend.size()) out.num.push_back(carried * m.K / (m.integrating ? 1 : m.T));
    }
    if (std::abs(carried) > kPoleTolerance * size)
        return Error{
            ErrorKind::unsupported, "controller/F",
            "F does not cancel the pole of the model at " + text(pole) +
                ", so the prediction would be unbounded. Use the filter of kind filtered_smith for this model."};
    if (out.num.empty()) out.num = {0};
    return out;
}

/// The program, part by part in the order in which a call computes them.
class Predictor {
public:
    Predictor(const PredictorModel& model, double Ts)
        : stable_(!model.integrating && model.T > 0), delay_(in_samples(model.L, Ts)) {
        const auto growth = [&](double h) {
            return model.integrating ? model.K * h : model.K * -std::expm1(-h / model.T);
        };
        a_ = model.integrating ? 1 : std::exp(-Ts / model.T);
        b_ = growth(Ts);
        b_rest_ = growth(delay_.rest);
    }

    /// `late`: of what the dead time has left; `F` of the measurement.
    Program build(const Program& pid, const HeldSystem& F, const HeldSystem& late, std::vector<std::string> notes) {
        const Expr r = whole_.input("setpoint", "r"), y = whole_.input("measurement", "y"),
                   manual = whole_.optional_input("manual", "true: u is manual_output", Type::boolean),
                   manual_output = whole_.optional_input("manual_output", "the operator's u", Type::real),
                   u = whole_.output("u", "the controller's output"), bias = whole_.setting_of(pid, "bias", "bias"),
                   y0 = whole_.setting_of(pid, "y0", "y0"), at_rest = whole_.setting_of(pid, "at_rest", "at_rest"),
                   restart = whole_.setting_of(pid, "restart", "restart");
        const Expr u_base = whole_.state("u_base", "u of the first call: the model has what u differs from it"),
                   y_base = whole_.state("y_base", "y of the first call"),
                   error = whole_.local("model_error", "what the model has not predicted of y"),
                   prediction = whole_.local("prediction", "y without the dead time");
        whole_.begin_with(assign(u_base, bias));
        whole_.begin_with(when(both(manual, inverse(at_rest)), {assign(u_base, manual_output)}));
        whole_.begin_with(assign(y_base, y));
        whole_.begin_with(when(at_rest, {assign(y_base, y0)}));
        declare_past();
        whole_.add(code::remark("The prediction."));
        const Expr rest = whole_.system_output("late", late.system, 0.0);
        whole_.add(assign(error, stable_ ? y - y_base - rest : y - y_base));
        const Expr filtered = whole_.system_output("filter", F.system, error);
        const Expr now = stable_ ? whole_.system_output("model", model(), 0.0) : past_alone();
        whole_.add(assign(prediction, stable_ ? y_base + now + filtered : y_base + now + rest + filtered));
        whole_.add(whole_
                       .embed(pid, {.renamed = [](const std::string& name) { return name; },
                                    .bound = {{"setpoint", r},
                                              {"measurement", prediction},
                                              {"manual", manual},
                                              {"manual_output", manual_output}}})
                       .body);
        whole_.add(code::remark("The model moves by the u that the limits have left."));
        remember(u - u_base);
        if (stable_) whole_.move_system("model", model(), v_);
        whole_.move_system("late", late.system, element(ring_, place_), late.Gamma1, oldest_);
        whole_.move_system("filter", F.system, error);
        return whole_.take(restart, std::move(notes));
    }

private:
    int length() const { return delay_.whole + 1; }
    DiscreteSystem model() const { return {.Phi = {a_}, .Gamma = {b_}, .C = {1}}; }

    void declare_past() {
        ring_ = whole_.state("past", "u of the last calls, in a ring", Type::real, length());
        place_ = whole_.state("past_place", "index of the oldest value in the ring", Type::integer);
        k_ = whole_.local("past_k", "counts", Type::integer);
        whole_.begin_with(repeat(k_, length(), {assign(element(ring_, k_), 0.0)}));
        whole_.begin_with(assign(place_, whole(0)));
        v_ = whole_.local("moved", "u less u_base");
        oldest_ = whole_.local("oldest", "the same before the dead time and a call");
    }

    void add_turn(code::Block& block, const Expr& index) const {
        block.push_back(assign(index, index + whole(1)));
        block.push_back(when(index >= whole(length()), {assign(index, whole(0))}));
    }

    /// The model's response to the u of the last dead time alone.
    Expr past_alone() {
        const Expr x = whole_.local("to_come", "what the last dead time's u will do to y"),
                   at = whole_.local("past_at", "index in the ring", Type::integer);
        whole_.add(assign(x, delay_.rest > 0 ? b_rest_ * element(ring_, place_) : Expr(0.0)));
        if (delay_.whole == 0) return x;
        whole_.add(assign(at, place_));
        code::Block body;
        add_turn(body, at);
        body.push_back(assign(x, (a_ == 1 ? x : a_ * x) + b_ * element(ring_, at)));
        whole_.add(repeat(k_, delay_.whole, std::move(body)));
        return x;
    }

    void remember(const Expr& v) {
        whole_.add(assign(v_, v));
        whole_.add(assign(oldest_, element(ring_, place_)));
        whole_.add(assign(element(ring_, place_), v_));
        code::Block turn;
        add_turn(turn, place_);
        whole_.add(turn);
    }

    const bool stable_;
    const SampledDelay delay_;
    double a_ = 0, b_ = 0, b_rest_ = 0;  // the model over one call, and over the rest of the dead time
    Composer whole_{"predictor", "PID controller with a predictor"};
    Expr ring_ = 0, place_ = 0, k_ = 0, v_ = 0, oldest_ = 0;
};

std::string model_note(const PredictorModel& m) {
    const std::string dead_time = " with the dead time Lm = " + text(m.L, 6) + " s. ";
    const std::string lag = m.integrating ? "/s" : "/(" + text(m.T, 6) + " s + 1)";
    std::string out = "Predictor: the controller's measurement is the prediction Gm u + F (y - Gm e^(-Lm s) u). Gm = " +
                      text(m.K, 6) + lag + dead_time +
                      "The model is exact for a u that is held between calls; limits and manual included. ";
    if (m.integrating || m.T < 0)
        out += "It is computed from the u of the last dead time, so that its state cannot drift. ";
    return out + "Its numbers, Ts and the dead time in calls are written into the program: write it again for others.";
}

}  // namespace

Expected<ParallelPid> predictor_pid(const PredictorController& controller) {
    std::vector<double> num = controller.C.num, den = controller.C.den;
    for (auto* side : {&num, &den})
        while (side->size() > 1 && side->front() == 0) side->erase(side->begin());
    const bool integral = den.back() == 0;
    if (integral && den.size() > 1) den.pop_back();
    const bool filtered = den.size() == 2;
    const std::size_t most = (integral ? 1U : 0U) + (filtered ? 1U : 0U) + 1U;
    if (den.size() > 2 || den.back() == 0 || num.size() > most)
        return Error{ErrorKind::unsupported, "controller/C",
                     "A program needs a C that is a PID: at most an integrator and a lag in its denominator, and a "
                     "numerator of no higher order."};
    num.insert(num.begin(), most - num.size(), 0.0);
    for (double& c : num) c /= den.back();
    const double Tf = filtered ? den.front() / den.back() : 0;
    if (filtered && !(Tf > 0))
        return Error{ErrorKind::unsupported, "controller/C", "C is not stable. A program needs a C that is a PID."};
    ParallelPid pid;
    // Kp + Ki/s + Kd s/(Tf s + 1), coefficient by coefficient.
    if (integral) {
        pid.Ki = num.back();
        num.pop_back();
    }
    pid.Kp = (num.empty() ? 0 : num.back()) - pid.Ki * Tf;
    if (!filtered) return pid;
    pid.Kd = num.front() - pid.Kp * Tf;
    pid.filter = {.type = FilterType::derivative, .Tf = Tf};
    return pid;
}

Expected<Program> predictor_program(const PredictorController& controller, double Ts, const code::CodeOptions& u) {
    const auto gains = predictor_pid(controller);
    if (!gains) return gains.error();
    const PredictorModel& m = controller.model;
    const auto pid = code::pid_algorithm({.gains = *gains, .Ts = Ts}, u);
    if (!pid) return pid;
    if (m.L > code::kMaxDelayCalls * Ts)
        return Error{ErrorKind::invalid_argument, "sample_time",
                     "The dead time is " + text(m.L) + " s, more than " + std::to_string(code::kMaxDelayCalls) +
                         " sample times of " + text(Ts) + " s. Give a longer sample_time."};
    const bool stable = !m.integrating && m.T > 0;
    const auto rest = stable ? Expected<Rational>(Rational{{m.K}, {m.T, 1}}) : without_pole(m, controller.F);
    if (!rest) return rest.error();
    const auto F = realised(controller.F), late = realised(*rest);
    if (!F) return F.error();
    if (!late) return late.error();
    std::vector<std::string> notes = pid->notes;
    notes.insert(notes.begin(), model_note(m));
    return Predictor(m, Ts).build(*pid, HeldSystem(*F, Ts, 0), HeldSystem(*late, Ts, in_samples(m.L, Ts).rest),
                                  std::move(notes));
}

}  // namespace tunewright::structure
