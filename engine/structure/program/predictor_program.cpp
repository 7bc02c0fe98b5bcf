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

using code::Block;
using code::Composer;
using code::DiscreteSystem;
using code::Expr;
using code::Program;
using code::Type;

constexpr double kPoleTolerance = 1e-3;  // of F at the model's pole: coefficients may be rounded to four digits

Expected<Realisation> realised(const Rational& r) {
    const auto plant = LinearPlant::make(Plant(TransferFunction{.num = r.num, .den = r.den}));
    if (!plant) return plant.error();
    return plant->realisation();
}

/// The system over one call, with an input that is held and arrives `rest` after the call begins.
DiscreteSystem discrete(const Realisation& plant, double Ts, double rest) {
    const HeldMotion motion(plant, 1, false);
    const HeldStep whole = motion.step(Ts), after = motion.step(Ts - rest);
    DiscreteSystem out{.Phi = whole.Phi, .Gamma = after.Gamma, .C = plant.C, .D = plant.D};
    if (rest == 0) return out;
    out.Gamma_late.resize(plant.C.size());
    multiply(after.Phi, motion.step(rest).Gamma, out.Gamma_late);
    return out;
}

/// The next place of the ring of u, of the calls within the dead time and one before.
Block turned(const Expr& place, const SampledDelay& delay) {
    return {assign(place, place + code::whole(1)),
            when(place >= code::whole(delay.whole + 1), {assign(place, code::whole(0))})};
}

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

/// Adds the model's response to the u of the last dead time alone, and returns it.
Expr add_past(Composer& whole, const PredictorModel& m, const SampledDelay& delay, double Ts) {
    const auto growth = [&](double h) { return m.integrating ? m.K * h : m.K * -std::expm1(-h / m.T); };
    const Expr past = whole["past"], place = whole["past_place"],
               x = whole.let("to_come", "what the last dead time's u will do to y",
                             growth(delay.rest) * element(past, place));
    if (delay.whole == 0) return x;
    const Expr at = whole.let("past_at", "index in the ring", place);
    Block step = turned(at, delay);
    const Expr grown = m.integrating ? x : std::exp(-Ts / m.T) * x;
    step.push_back(assign(x, grown + growth(Ts) * element(past, at)));
    whole.add(repeat(whole["past_k"], delay.whole, std::move(step)));
    return x;
}

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

Expected<Program> predictor_program(const PredictorController& controller, const SampledPid& law,
                                    const code::CodeOptions& u) {
    const double Ts = law.Ts;
    const PredictorModel& m = controller.model;
    const auto pid = code::pid_algorithm(law, u);
    if (!pid) return pid;
    if (m.L > code::kMaxDelayCalls * Ts)
        return Error{ErrorKind::invalid_argument, "sample_time",
                     "The dead time is " + text(m.L) + " s, more than " + std::to_string(code::kMaxDelayCalls) +
                         " sample times of " + text(Ts) + " s. Give a longer sample_time."};
    const bool stable = !m.integrating && m.T > 0;
    const Rational Gm{{m.K}, {m.T, 1}};
    const auto rest = stable ? Expected<Rational>(Gm) : without_pole(m, controller.F);
    if (!rest) return rest.error();
    const auto filter = realised(controller.F), late = realised(*rest), model = realised(Gm);
    for (const auto* system : {&filter, &late, &model})
        if (!*system) return system->error();
    const SampledDelay delay = in_samples(m.L, Ts);
    const DiscreteSystem F = discrete(*filter, Ts, 0), behind = discrete(*late, Ts, delay.rest),
                         ahead = discrete(*model, Ts, 0);

    Composer whole("predictor", "PID controller with a predictor", Ts);
    whole.input("setpoint", "r");
    const Expr y = whole.input("measurement", "y"),
               manual = whole.optional_input("manual", "true: u is manual_output", Type::boolean),
               by_hand = whole.optional_input("manual_output", "the operator's u", Type::real),
               out = whole.output("u", "the controller's output"), at_rest = whole["at_rest"],
               bias = whole.setting("bias", u.bias, "u at the operating point"),
               y0 = whole.setting("y0", u.y0, "y at the operating point");
    const Expr u_base = whole.state("u_base", "u of the first call: the model has what u differs from it"),
               y_base = whole.state("y_base", "y of the first call"),
               past = whole.state("past", "u of the last calls, in a ring", Type::real, delay.whole + 1),
               place = whole.state("past_place", "index of the oldest value in the ring", Type::integer),
               k = whole.local("past_k", "counts", Type::integer);
    whole.begin_with(assign(u_base, bias));
    whole.begin_with(when(both(manual, inverse(at_rest)), {assign(u_base, by_hand)}));
    whole.begin_with(assign(y_base, y));
    whole.begin_with(when(at_rest, {assign(y_base, y0)}));
    whole.begin_with(repeat(k, delay.whole + 1, {assign(element(past, k), 0.0)}));
    whole.begin_with(assign(place, code::whole(0)));

    whole.add(code::remark("The prediction: y without the dead time."));
    const Expr L = whole.system("late", behind, 0.0),
               error = whole.let("model_error", "input of the filter", stable ? y - y_base - L : y - y_base),
               filtered = whole.system("filtered", F, error),
               now = stable ? whole.system("model", ahead, 0.0) : add_past(whole, m, delay, Ts) + L;
    whole.let("prediction", "y without the dead time", y_base + now + filtered);
    whole.embed(*pid, {{"measurement", "prediction"}});
    whole.add(code::remark("The model moves by the u that the limits have left."));
    const Expr v = whole.let("moved", "u less u_base", out - u_base),
               oldest = whole.let("oldest", "the same a call before the dead time", element(past, place));
    whole.add(assign(element(past, place), v));
    for (const code::Statement& statement : turned(place, delay)) whole.add(statement);
    if (stable) whole.move("model", ahead, v);
    whole.move("late", behind, element(past, place), oldest);
    whole.move("filtered", F, error);
    std::vector<std::string> notes = pid->notes;
    notes.insert(notes.begin(), model_note(m));
    return whole.take(std::move(notes));
}

}  // namespace tunewright::structure
