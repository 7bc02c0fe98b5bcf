#include "engine/structure/program/loop_programs.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/code/composer.h"
#include "engine/code/settings.h"
#include "engine/number_text.h"

namespace tunewright::structure {
namespace {

using code::Block;
using code::CodeOptions;
using code::Composer;
using code::Embedded;
using code::Expr;
using code::PidNote;
using code::Program;
using code::Type;

/// The program of one controller; its errors are located at `where`.
Expected<Program> part(const SampledPid& pid, const CodeOptions& options, const std::string& where) {
    if (pid.velocity)
        return Error{ErrorKind::unsupported, "form",
                     "A program with several loops or parts needs the integral part of the form position; form is "
                     "velocity."};
    auto program = code::pid_algorithm(pid, options);
    if (program || where.empty()) return program;
    Error error = program.error();
    error.where = where + "/" + error.where;
    return error;
}

std::string note(const Program& program, PidNote which) { return program.notes[static_cast<std::size_t>(which)]; }

std::optional<Error> refused(const Feedforward& part, double Ts, const std::string& where) {
    for (const double time : {part.Tz, part.Tp, part.Lf})
        if (!std::isfinite(part.Kf) || !std::isfinite(time) || time < 0)
            return Error{ErrorKind::invalid_argument, where, "Kf, Tz, Tp and Lf must be finite, the times >= 0."};
    if (part.Lf > code::kMaxDelayCalls * Ts)
        return Error{ErrorKind::invalid_argument, where + "/Lf",
                     "Lf is " + text(part.Lf) + " s, more than " + std::to_string(code::kMaxDelayCalls) +
                         " sample times of " + text(Ts) + " s. Give a longer sample_time."};
    return std::nullopt;
}

/// True for the settings that all controllers of a program share.
bool kept(const std::string& name) { return name == "Ts" || name == "at_rest" || name == "restart"; }

/// A controller whose output is a part of u: `added` comes to it. Names end with `suffix`.
class AddedTo {
public:
    AddedTo(Composer& whole, const Program& pid, const std::string& suffix) : whole_(whole), pid_(pid), s_(suffix) {
        setpoint_ = whole.input("setpoint" + s_, "r");
        measurement_ = whole.input("measurement" + s_, "y");
    }

    void declare_manual() {
        manual_ = whole_.optional_input("manual" + s_, "true: u is manual_output", Type::boolean);
        manual_output_ = whole_.optional_input("manual_output" + s_, "the operator's u", Type::real);
        u_ = whole_.output("u" + s_, "the controller's output");
        for (auto [name, place] : {std::pair{"u_min", &u_min_}, {"u_max", &u_max_}, {"bias", &bias_}})
            *place = whole_.setting_of(pid_, name, name + s_);
        for (auto [name, place] : {std::pair{"at_rest", &at_rest_}, {"restart", &restart_}, {"Ts", &Ts_}})
            *place = whole_.setting_of(pid_, name, name);
    }
    /// u of the last call.
    Expr u_before() {
        if (!u_before_) {
            u_before_ = whole_.state("u_before" + s_, "u of the last call");
            whole_.begin_with(assign(*u_before_, bias_));
        }
        return *u_before_;
    }
    void keep_for_next_call() {
        if (u_before_) whole_.add(assign(*u_before_, u_));
    }

    /// The controller alone.
    void add() {
        whole_.add(whole_
                       .embed(pid_, {.renamed = [&](const std::string& name) { return kept(name) ? name : name + s_; },
                                     .bound = {{"setpoint", setpoint_},
                                               {"measurement", measurement_},
                                               {"manual", manual_},
                                               {"manual_output", manual_output_}}})
                       .body);
    }

    void add(const Expr& added) {
        const Expr in_bias = whole_.local("in_bias" + s_, "what of it is in u at the beginning");
        const Embedded pid = whole_.embed(pid_, {.renamed = [&](const std::string& name) { return renamed(name); },
                                                 .bound = {{"setpoint", setpoint_},
                                                           {"measurement", measurement_},
                                                           {"manual", manual_},
                                                           {"manual_output", manual_output_ - added},
                                                           {"u_min", u_min_ - added},
                                                           {"u_max", u_max_ - added},
                                                           {"bias", bias_ - in_bias}}});
        whole_.add(code::remark("The feedback has what is left of the limits."));
        whole_.add(assign(in_bias, 0.0));
        whole_.add(when(inverse(at_rest_), {assign(in_bias, added)}));
        whole_.add(assign(pid["u_last"], u_before() - added));
        whole_.add(pid.body);
        whole_.add(code::remark("The sum, without what rounding adds at a limit."));
        Block sum{assign(u_, pid["u"] + added)};
        keep_within(sum, u_, u_min_, u_max_);
        whole_.add(sum);
    }

    const Expr& bias() const { return bias_; }
    const Expr& at_rest() const { return at_rest_; }
    const Expr& restart() const { return restart_; }
    const Expr& Ts() const { return Ts_; }

private:
    std::string renamed(const std::string& name) const {
        if (kept(name)) return name;
        return (name == "u" ? "feedback" : name == "u_last" ? "feedback_last" : name) + s_;
    }

    Composer& whole_;
    const Program& pid_;
    const std::string s_;
    Expr setpoint_ = 0, measurement_ = 0, manual_ = 0, manual_output_ = 0, u_ = 0;
    std::optional<Expr> u_before_;
    Expr u_min_ = 0, u_max_ = 0, bias_ = 0, at_rest_ = 0, restart_ = 0, Ts_ = 0;
};

/// The lead-lag and the dead time of a compensator, less `seconds` that the signal has been late anyway.
Expr compensated(Composer& whole, const std::string& name, const Feedforward& part, const Expr& x, const Expr& before,
                 const Expr& Ts, double sample_time, double seconds = 0) {
    const Expr K = whole.setting("Kf" + name, part.Kf, "gain of the compensator"),
               Tz = whole.setting("T_lead" + name, part.Tz, "its lead in s"),
               Tp = whole.setting("T_lag" + name, part.Tp, "its lag in s");
    const Expr out = whole.lead_lag("lead_lag" + name, x, before, K, Tz, Tp, Ts);
    const double calls = std::max(part.Lf - seconds, 0.0) / sample_time, nearest = std::round(calls);
    constexpr double kMultiple = 1e-9;  // rounding of a dead time that is a multiple of the sample time
    const double used = std::abs(calls - nearest) < kMultiple ? nearest : calls;
    if (!(used > 0)) return out;
    const bool zero = std::holds_alternative<code::Literal>(before->what);
    return whole.delayed("late" + name, out, zero ? before : K * before, used);
}

constexpr const char* kSumLimits =
    "Limits: u stays from u_min to u_max, and in automatic it moves by at most rate_limit in a second (0: no limit). "
    "The controller's own limits are these less what is added to it, so that its anti-windup sees the limits of u.";
constexpr const char* kSumManual =
    "Manual: u is manual_output, limited by u_min and u_max. The integral part follows, what is added included, so "
    "that "
    "u does not jump at the switch to automatic.";
constexpr const char* kSumStart =
    "First call: u begins at manual_output in manual, at bias in automatic, whatever is added; all parts begin as if "
    "the inputs had been constant before. With at_rest the loop is assumed to have been at rest at the operating point "
    "until then. Without integral action u is the law at once.";
constexpr const char* kFixedTime = " A dead time is counted in calls: write the program again for another Ts.";

/// The cascade, controller by controller in the order in which a call computes them.
class Cascade {
public:
    Cascade(const Program& inner, const Program& outer, double reset_time)
        : inner_(inner), outer_(outer), reset_time_(reset_time) {}

    Program build(bool integral) {
        declare();
        add_outer();
        add_inner();
        if (integral) add_external_reset();
        return whole_.take(whole_.setting_of(outer_, "restart", "restart"), {});
    }

private:
    void declare() {
        setpoint_ = whole_.input("setpoint", "r1, of the outer controller");
        measurement_ = whole_.input("measurement", "y1, of the outer controller");
        inner_measurement_ = whole_.input("inner_measurement", "y2, of the inner controller");
        cascade_ = whole_.optional_input("cascade_on", "true: the outer controller gives r2", Type::boolean, 1);
        inner_setpoint_ = whole_.optional_input("inner_setpoint", "the operator's r2", Type::real);
        manual_ = whole_.optional_input("manual", "true: u is manual_output", Type::boolean);
        manual_output_ = whole_.optional_input("manual_output", "the operator's u", Type::real);
        u_ = whole_.output("u", "the inner controller's output");
        r2_ = whole_.output("r2", "the inner controller's set point");
        whole_.setting_of(outer_, "u_min", "r2_min", "least r2");
        whole_.setting_of(outer_, "u_max", "r2_max", "largest r2");
        r2_bias_ = whole_.setting_of(outer_, "bias", "r2_bias", "r2 and y2 at the operating point");
        at_rest_ = whole_.setting_of(outer_, "at_rest", "at_rest");
    }

    static std::string prefixed(const char* prefix, const std::string& name) {
        return kept(name) ? name : prefix + name;
    }

    void add_outer() {
        follows_ = whole_.local("follows", "true: the outer controller follows r2", Type::boolean);
        const Expr followed = whole_.local("followed", "r2 without the outer controller"),
                   start = whole_.local("r2_start", "r2 in a first call");
        whole_.add(code::remark("Without cascade_on the operator gives r2, and in manual it is y2."));
        whole_.add(assign(follows_, either(manual_, inverse(cascade_))));
        whole_.add(assign(followed, inner_setpoint_));
        whole_.add(when(manual_, {assign(followed, inner_measurement_)}));
        whole_.add(assign(start, inner_measurement_));
        whole_.add(when(at_rest_, {assign(start, r2_bias_)}));
        const Embedded pid = whole_.embed(outer_, {.renamed =
                                                       [](const std::string& name) {
                                                           if (name == "u") return std::string("r2");
                                                           if (name == "u_min") return std::string("r2_min");
                                                           if (name == "u_max") return std::string("r2_max");
                                                           return prefixed("outer_", name);
                                                       },
                                                   .bound = {{"setpoint", setpoint_},
                                                             {"measurement", measurement_},
                                                             {"manual", follows_},
                                                             {"manual_output", followed},
                                                             {"bias", start}}});
        whole_.add(code::remark("The outer controller."));
        whole_.add(pid.body);
        if (pid.variables.contains("integral")) outer_integral_ = pid["integral"];
        Ts_ = pid["Ts"];
    }

    void add_inner() {
        const Embedded pid =
            whole_.embed(inner_, {.renamed =
                                      [](const std::string& name) {
                                          for (const char* own : {"u", "u_min", "u_max", "rate_limit", "bias"})
                                              if (name == own) return name;
                                          return prefixed("inner_", name);
                                      },
                                  .bound = {{"setpoint", r2_},
                                            {"measurement", inner_measurement_},
                                            {"manual", manual_},
                                            {"manual_output", manual_output_},
                                            {"y0", r2_bias_}}});
        whole_.add(code::remark("The inner controller."));
        whole_.add(pid.body);
        high_ = pid["high"];
        low_ = pid["low"];
        direct_ = pid["direct"];
    }

    void add_external_reset() {
        const Expr reset_time = whole_.setting("reset_time", reset_time_, "lag of the external reset in s"),
                   missing = whole_.local("missing", "what y2 lacks, in the direction of u"),
                   held = whole_.local("held", "true: a limit keeps u from moving y2 to r2", Type::boolean);
        whole_.add(code::remark("External reset: while a limit holds u the outer integral part follows y2."));
        whole_.add(assign(missing, r2_ - inner_measurement_));
        whole_.add(when(direct_, {assign(missing, inner_measurement_ - r2_)}));
        whole_.add(assign(held, either(both(u_ >= high_, missing > 0), both(low_ >= u_, missing < 0))));
        whole_.add(
            when(both(held, inverse(follows_)),
                 {assign(outer_integral_, outer_integral_ + Ts_ / (reset_time + Ts_) * (inner_measurement_ - r2_))}));
    }

    const Program &inner_, &outer_;
    const double reset_time_;
    Composer whole_{"cascade", "PID cascade"};
    Expr setpoint_ = 0, measurement_ = 0, inner_measurement_ = 0, cascade_ = 0, inner_setpoint_ = 0, manual_ = 0,
         manual_output_ = 0, u_ = 0, r2_ = 0, r2_bias_ = 0, at_rest_ = 0, Ts_ = 0;
    Expr follows_ = 0, outer_integral_ = 0, low_ = 0, high_ = 0, direct_ = 0;
};

}  // namespace

Expected<Program> cascade_program(const SampledPid& inner, const SampledPid& outer, const CodeOptions& u,
                                  const CodeOptions& r2) {
    const auto C2 = part(inner, u, "inner"), C1 = part(outer, r2, "outer");
    if (!C2) return C2.error();
    if (!C1) return C1.error();
    const bool integral = outer.gains.Ki != 0;
    // Without a proportional part there is no Ti; ten calls keep r2 from jumping at every call at a limit.
    constexpr double kCalls = 10;
    const double Ti = integral ? std::abs(outer.gains.Kp / outer.gains.Ki) : 0;
    Program program = Cascade(*C2, *C1, Ti > 0 ? Ti : kCalls * outer.Ts).build(integral);
    program.notes = {
        "Cascade: the outer controller acts on y1, and its output r2 is the set point of the inner controller, which "
        "acts "
        "on y2 and moves u. Names of variables begin with outer_ and inner_; those of u, r2 and Ts do not.",
        "Inner controller, with r2 and y2. " + note(*C2, PidNote::law),
        "Outer controller, with r1 and y1; its u is r2. " + note(*C1, PidNote::law),
        "Range of r2: r2_min to r2_max; set them to what y2 can reach.",
        note(*C2, PidNote::limits),
        "Inner controller. " + note(*C2, PidNote::windup) + " Outer controller, at r2_min and r2_max. " +
            note(*C1, PidNote::windup),
    };
    if (integral)
        program.notes.emplace_back(
            "External reset: while a limit holds u, so that y2 cannot become r2, the outer integral part follows y2: "
            "each "
            "call it moves by Ts/(reset_time + Ts) of y2 - r2. In this way it does not wind up. Otherwise the outer "
            "law is untouched.");
    program.notes.insert(
        program.notes.end(),
        {"Manual: u is manual_output, limited by u_min and u_max, and r2 is y2. Without cascade_on the inner "
         "controller is in "
         "automatic with the operator's inner_setpoint as r2. In both cases the outer controller's integral part "
         "follows r2, so that neither r2 nor u jumps when the cascade returns.",
         "Changes: gains, integral and derivative times and weights b may be changed between two calls, and u does not "
         "jump. The limits may be changed too. Change Ts and filter times only with a restart, in manual at the "
         "present "
         "u.",
         "First call: r2 begins at y2, and u at manual_output in manual, at bias in automatic. With at_rest the loops "
         "are "
         "assumed to have been at rest at y1 = outer_y0, y2 = r2 = r2_bias, u = bias until then."});
    return program;
}

Expected<Program> feedforward_program(const SampledPid& feedback, const Feedforward& compensator, const CodeOptions& u,
                                      double d0) {
    const auto pid = part(feedback, u, "feedback");
    if (!pid) return pid.error();
    if (auto error = refused(compensator, feedback.Ts, "feedforward")) return *error;
    Composer whole("feedforward", "PID controller with feedforward");
    AddedTo controller(whole, *pid, "");
    const Expr d = whole.input("disturbance", "d, the measured disturbance");
    controller.declare_manual();
    const Expr d_0 = whole.setting("d0", d0, "d at the operating point"),
               x = whole.local("deviation", "d from its operating point"),
               before = whole.local("deviation_before", "the same before the first call"),
               part_of_u = whole.local("compensation", "what is added to the controller's output");
    whole.begin_with(assign(before, d - d_0));
    whole.begin_with(when(controller.at_rest(), {assign(before, 0.0)}));
    whole.add(code::remark("The feedforward."));
    whole.add(assign(x, d - d_0));
    const Expr F = compensated(whole, "", compensator, x, before, controller.Ts(), feedback.Ts);
    whole.add(assign(part_of_u, -F));
    controller.add(part_of_u);
    controller.keep_for_next_call();
    return whole.take(
        controller.restart(),
        {"Feedforward: from the controller's output Kf (T_lead s + 1)/(T_lag s + 1) of d - d0 is subtracted, by "
         "backward Euler" +
             std::string(compensator.Lf > 0 ? ", after the dead time of " + text(compensator.Lf) + " s. " : ". ") +
             "A lasting change of d by 1 moves u by -Kf.",
         note(*pid, PidNote::law), kSumLimits, note(*pid, PidNote::windup), kSumManual,
         note(*pid, PidNote::changes) +
             " Kf, T_lead and T_lag may be changed, best while d is constant: u then moves at once to what they give." +
             (compensator.Lf > 0 ? kFixedTime : ""),
         kSumStart});
}

Expected<Program> level_program(const SampledPid& pid, const CodeOptions& u, double gap, double gap_gain) {
    auto controller = part(pid, u, "");
    if (!controller) return controller;
    if (!(gap >= 0) || !std::isfinite(gap) || !(gap_gain >= 0 && gap_gain <= 1))
        return Error{ErrorKind::invalid_argument, "gap",
                     "gap is " + text(gap) + " and gap_gain " + text(gap_gain) +
                         "; gap must be >= 0, and gap_gain from 0 to 1."};
    Composer whole("level", "PID level controller");
    const Expr r = whole.input("setpoint", "r"), y = whole.input("measurement", "y");
    whole.output("u", "the controller's output");
    Expr counted = y;
    if (gap > 0) {
        const Expr width = whole.setting("gap", gap, "error within which only gap_gain of it counts"),
                   share = whole.setting("gap_gain", gap_gain, "share of the error that counts within the gap"),
                   error = whole.local("level_error", "r - y"), inside = whole.local("inside", "its part in the gap");
        counted = whole.local("counted", "the measurement for the controller");
        whole.add(code::remark("The gap: of the error's part within it only a share counts."));
        whole.add(assign(error, r - y));
        whole.add(assign(inside, error));
        Block within;
        keep_within(within, inside, -width, width);
        whole.add(within);
        whole.add(assign(counted, r - (error - (1 - share) * inside)));
    }
    whole.add(whole
                  .embed(*controller, {.renamed = [](const std::string& name) { return name; },
                                       .bound = {{"setpoint", r}, {"measurement", counted}}})
                  .body);
    std::vector<std::string> notes = controller->notes;
    if (gap > 0)
        notes.insert(
            notes.begin(),
            "Gap: while the level is within gap of the set point the controller sees gap_gain of the error, so "
            "that u rests. Outside it sees the error less (1 - gap_gain) gap: there is no step at the edge. In "
            "the law below y is the measurement that gives this error.");
    return whole.take(whole.setting_of(*controller, "restart", "restart"), std::move(notes));
}

Expected<Program> interaction_program(const std::vector<SampledPid>& controllers, const std::vector<CodeOptions>& u,
                                      const Decoupling& elements) {
    const std::size_t n = controllers.size();
    std::vector<Program> programs;
    for (std::size_t i = 0; i < n; ++i) {
        auto program = part(controllers[i], u[i], "controllers/" + std::to_string(i));
        if (!program) return program;
        programs.push_back(std::move(*program));
    }
    const double Ts = controllers.front().Ts;
    Composer whole("loops", "PID group for interacting loops");
    std::vector<AddedTo> loops;
    for (std::size_t i = 0; i < n; ++i) loops.emplace_back(whole, programs[i], "_" + std::to_string(i + 1));
    for (AddedTo& loop : loops) loop.declare_manual();
    std::vector<std::string> notes{
        "Loops: controller i acts on measurement_i and moves u_i. The numbers at the end of names are those of the "
        "loops; "
        "Ts, at_rest and restart are for all. Each loop may be in manual by itself."};
    bool decoupled = false, counted = false;
    std::vector<std::optional<Expr>> added(n);
    for (std::size_t i = 0; i < elements.size(); ++i) {
        for (std::size_t j = 0; j < elements[i].size(); ++j) {
            if (!elements[i][j]) continue;
            const std::string name = "_" + std::to_string(i + 1) + std::to_string(j + 1);
            if (auto error = refused(*elements[i][j], Ts, "decoupling/" + std::to_string(i) + "/" + std::to_string(j)))
                return *error;
            const Expr x = whole.local("deviation" + name, "u of the other loop from its operating point");
            whole.add(code::remark("From u_" + std::to_string(j + 1) + " to u_" + std::to_string(i + 1) + "."));
            whole.add(assign(x, loops[j].u_before() - loops[j].bias()));
            const Expr D = compensated(whole, name, *elements[i][j], x, 0.0, loops[i].Ts(), Ts, Ts);
            added[i] = added[i] ? *added[i] + D : D;
            decoupled = true;
            counted = counted || elements[i][j]->Lf > 0;
        }
    }
    for (std::size_t i = 0; i < n; ++i) {
        whole.add(code::remark("Loop " + std::to_string(i + 1) + "."));
        if (!added[i]) {
            loops[i].add();
        } else {
            const Expr sum =
                whole.local("decoupling_" + std::to_string(i + 1), "what is added to the controller's output");
            whole.add(assign(sum, *added[i]));
            loops[i].add(sum);
        }
        notes.push_back("Loop " + std::to_string(i + 1) + ". " + note(programs[i], PidNote::law) + " " +
                        note(programs[i], PidNote::windup));
    }
    for (AddedTo& loop : loops) loop.keep_for_next_call();
    if (decoupled)
        notes.insert(
            notes.begin() + 1,
            std::string("Decoupling: to controller i's output comes Kf_ij (T_lead_ij s + 1)/(T_lag_ij s + 1) of u_j - "
                        "bias_j, by backward Euler, after the dead time. u_j is that of the last call, as "
                        "limits or manual have left it; this call counts as a part of the dead time.") +
                (counted ? kFixedTime : ""));
    for (const std::string& sentence :
         decoupled ? std::vector<std::string>{kSumLimits, kSumManual, note(programs[0], PidNote::changes), kSumStart}
                   : std::vector<std::string>{note(programs[0], PidNote::limits), note(programs[0], PidNote::manual),
                                              note(programs[0], PidNote::changes), note(programs[0], PidNote::start)})
        notes.push_back(sentence);
    return whole.take(loops.front().restart(), std::move(notes));
}

std::optional<double> proposed_sample_time(const std::vector<ParallelPid>& controllers) {
    std::optional<double> shortest;
    for (const ParallelPid& gains : controllers)
        if (const auto own = code::proposed_sample_time(gains))
            shortest = std::min(shortest.value_or(std::numeric_limits<double>::infinity()), *own);
    return shortest;
}

}  // namespace tunewright::structure
