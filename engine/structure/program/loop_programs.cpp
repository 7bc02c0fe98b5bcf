#include "engine/structure/program/loop_programs.h"

#include <algorithm>
#include <cctype>
#include <cmath>

#include "engine/code/composer.h"
#include "engine/loop/sampled/held_plant.h"
#include "engine/number_text.h"

namespace tunewright::structure {
namespace {

using code::Block;
using code::CodeOptions;
using code::Composer;
using code::Expr;
using code::PidNote;
using code::Program;
using code::Type;

/// The program of one controller; its errors are located at `where`.
Expected<Program> part(const SampledPid& pid, const CodeOptions& options, const std::string& where) {
    if (pid.velocity) return Error{ErrorKind::unsupported, "form", "form is velocity; here it must be position."};
    auto program = code::pid_algorithm(pid, options);
    if (program || where.empty()) return program;
    Error error = program.error();
    error.where = where + "/" + error.where;
    return error;
}

std::string note(const Program& program, PidNote which) { return program.notes[static_cast<std::size_t>(which)]; }

/// The program with this name of its output in its comments.
Program with_output(Program program, const std::string& name) {
    const auto is_letter = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; };
    for (code::Declaration& one : program.variables) {
        std::string& words = one.comment;
        for (std::size_t i = 0; i < words.size(); ++i) {
            const bool ends = i + 1 == words.size() || !is_letter(words[i + 1]);
            if (words[i] == 'u' && ends && (i == 0 || !is_letter(words[i - 1]))) words.replace(i, 1, name);
        }
    }
    return program;
}

std::optional<Error> refused(const Feedforward& part, double Ts, const std::string& where) {
    const double least = std::min({part.Tz, part.Tp, part.Lf});
    if (!std::isfinite(part.Kf + part.Tz + part.Tp + part.Lf) || least < 0)
        return Error{ErrorKind::invalid_argument, where, "Kf, Tz, Tp and Lf must be finite, the times >= 0."};
    if (part.Lf > code::kMaxDelayCalls * Ts)
        return Error{ErrorKind::invalid_argument, where + "/Lf",
                     "Lf is " + text(part.Lf) + " s, more than " + std::to_string(code::kMaxDelayCalls) +
                         " sample times of " + text(Ts) + " s. Give a longer sample_time."};
    return std::nullopt;
}

void declare_signals(Composer& whole, const std::string& suffix) {
    whole.input("setpoint" + suffix, "r");
    whole.input("measurement" + suffix, "y");
}

void declare_output(Composer& whole, const std::string& suffix) {
    whole.optional_input("manual" + suffix, "true: u is manual_output", Type::boolean);
    whole.optional_input("manual_output" + suffix, "the operator's u", Type::real);
    whole.output("u" + suffix, "the controller's output");
}

/// The settings and the memory of a u that add_to_controller() computes.
void declare_sum(Composer& whole, const CodeOptions& options, const std::string& s) {
    whole.setting("u_min" + s, options.u_min.value_or(-code::kNoLimit), "least u");
    whole.setting("u_max" + s, options.u_max.value_or(code::kNoLimit), "largest u");
    const Expr bias = whole.setting("bias" + s, options.bias, "u at the operating point");
    whole.begin_with(assign(whole.state("u_before" + s, "u of the last call"), bias));
}

/// u is the output of a controller and `added`; the controller has what that leaves of the limits, of manual_output and
/// of bias.
void add_to_controller(Composer& whole, const Program& pid, const std::string& s, const Expr& added) {
    const auto of = [&](const char* name) { return whole[name + s]; };
    whole.add(code::remark("The controller has what is left."));
    whole.let("min_left" + s, "of u_min", of("u_min") - added);
    whole.let("max_left" + s, "of u_max", of("u_max") - added);
    whole.let("manual_left" + s, "of manual_output", of("manual_output") - added);
    const Expr bias = whole.let("bias_left" + s, "of bias", of("bias"));
    whole.add(when(inverse(whole["at_rest"]), {assign(bias, of("bias") - added)}));
    whole.add(assign(whole.state("feedback_last" + s, "output of the last call, with what is added now"),
                     of("u_before") - added));
    whole.embed(pid,
                {{"manual_output", "manual_left" + s},
                 {"u", "feedback" + s},
                 {"u_min", "min_left" + s},
                 {"u_max", "max_left" + s},
                 {"bias", "bias_left" + s},
                 {"u_last", "feedback_last" + s}},
                "", s);
    whole.add(code::remark("The sum, without what rounding adds at a limit."));
    whole.add_bounded(of("u"), of("feedback") + added, of("u_min"), of("u_max"));
}

/// The output of a compensator whose input has been `seconds` late anyway.
Expr compensated(Composer& whole, const std::string& s, const Feedforward& part, const Expr& x, const Expr& before,
                 double Ts, double seconds = 0) {
    const SampledDelay delay = in_samples(std::max(part.Lf - seconds, 0.0), Ts);
    const Expr K = whole.setting("Kf" + s, part.Kf, "gain of the compensator"),
               lead = whole.setting("T_lead" + s, part.Tz, "its lead in s"),
               lag = whole.setting("T_lag" + s, part.Tp, "its lag in s"),
               late = whole.delayed("late" + s, x, before, delay.whole + delay.rest / Ts);
    return whole.lead_lag("lead_lag" + s, late, before, K, lead, lag);
}

std::vector<std::string> notes_on_sum() {
    return {
        "Limits: u stays from u_min to u_max, and in automatic it moves by at most rate_limit in a second (0: no "
        "limit). The controller's own limits are these less what is added to it, so that its anti-windup sees the "
        "limits of u.",
        "Manual: u is manual_output, limited by u_min and u_max. The integral part follows, so that u does not jump "
        "at the switch to automatic.",
        "First call: u begins at manual_output in manual, at bias in automatic, whatever is added. With at_rest the "
        "loop is assumed to have been at rest at the operating point until then. Without integral action u is the "
        "law at once.",
        "Dead times are counted in calls: write the program again for another Ts."};
}

/// While a limit holds u, the outer integral part follows y2.
void add_external_reset(Composer& whole, double reset_time) {
    const Expr r2 = whole["r2"], y2 = whole["inner_measurement"], u = whole["u"], Ts = whole["Ts"],
               integral = whole["outer_integral"],
               lag = whole.setting("reset_time", reset_time, "lag of the external reset in s");
    whole.add(code::remark("External reset: while a limit holds u the outer integral part follows y2."));
    const Expr missing = whole.let("missing", "what y2 lacks, in the direction of u", r2 - y2);
    whole.add(when(whole["inner_direct"], {assign(missing, y2 - r2)}));
    const Expr held =
        whole.let("held", "true: a limit keeps u from moving y2 to r2",
                  either(both(u >= whole["inner_high"], missing > 0), both(whole["inner_low"] >= u, missing < 0)));
    whole.add(when(both(held, inverse(whole["follows"])), {assign(integral, integral + Ts / (lag + Ts) * (y2 - r2))}));
}

}  // namespace

Expected<Program> cascade_program(const SampledPid& inner, const SampledPid& outer, const CodeOptions& u,
                                  const CodeOptions& r2) {
    const auto C2 = part(inner, u, "inner"), C1 = part(outer, r2, "outer");
    if (!C2) return C2.error();
    if (!C1) return C1.error();
    Composer whole("cascade", "PID cascade", inner.Ts);
    whole.input("setpoint", "r1, of the outer controller");
    whole.input("measurement", "y1, of the outer controller");
    const Expr y2 = whole.input("inner_measurement", "y2, of the inner controller"),
               on = whole.optional_input("cascade_on", "true: the outer controller gives r2", Type::boolean, 1),
               operators = whole.optional_input("inner_setpoint", "the operator's r2", Type::real),
               manual = whole.optional_input("manual", "true: u is manual_output", Type::boolean);
    whole.optional_input("manual_output", "the operator's u", Type::real);
    whole.output("u", "the inner controller's output");
    whole.output("r2", "the inner controller's set point");
    const Expr rest = whole.setting("r2_bias", r2.bias, "r2 and y2 at the operating point");

    whole.add(code::remark("Without cascade_on the operator gives r2, and in manual it is y2."));
    whole.let("follows", "true: the outer controller follows r2", either(manual, inverse(on)));
    const Expr followed = whole.let("followed", "r2 without the outer controller", operators);
    whole.add(when(manual, {assign(followed, y2)}));
    const Expr start = whole.let("r2_start", "r2 in a first call", y2);
    whole.add(when(whole["at_rest"], {assign(start, rest)}));
    whole.add(code::remark("The outer controller."));
    whole.embed(with_output(*C1, "r2"),
                {{"setpoint", "setpoint"},
                 {"measurement", "measurement"},
                 {"manual", "follows"},
                 {"manual_output", "followed"},
                 {"bias", "r2_start"},
                 {"u", "r2"},
                 {"u_min", "r2_min"},
                 {"u_max", "r2_max"}},
                "outer_");
    whole.add(code::remark("The inner controller."));
    whole.embed(*C2,
                {{"setpoint", "r2"},
                 {"manual", "manual"},
                 {"manual_output", "manual_output"},
                 {"y0", "r2_bias"},
                 {"u", "u"},
                 {"u_min", "u_min"},
                 {"u_max", "u_max"},
                 {"rate_limit", "rate_limit"},
                 {"bias", "bias"}},
                "inner_");
    const ParallelPid& gains = outer.gains;
    // Without a proportional part there is no Ti; ten calls keep r2 from jumping at every call at a limit.
    constexpr double kCalls = 10;
    if (gains.Ki != 0) add_external_reset(whole, gains.Kp != 0 ? std::abs(gains.Kp / gains.Ki) : kCalls * outer.Ts);
    return whole.take({
        "Cascade: the outer controller acts on y1, and its output r2 is the set point of the inner controller, which "
        "acts "
        "on y2 and moves u. Names of variables begin with outer_ and inner_; those of u, r2 and Ts do not.",
        "Inner controller, with r2 and y2. " + note(*C2, PidNote::law),
        "Outer controller, with r1 and y1; its u is r2. " + note(*C1, PidNote::law),
        "Range of r2: r2_min to r2_max; set them to what y2 can reach.",
        note(*C2, PidNote::limits),
        "Inner controller. " + note(*C2, PidNote::windup) + " Outer controller, at r2_min and r2_max. " +
            note(*C1, PidNote::windup) +
            " While a limit holds u, so that y2 cannot become r2, its integral part follows y2 instead: each call it "
            "moves "
            "by Ts/(reset_time + Ts) of y2 - r2 (external reset). Otherwise its law is untouched.",
        "Manual: u is manual_output, limited by u_min and u_max, and r2 is y2. Without cascade_on the inner controller "
        "is "
        "in automatic with inner_setpoint as r2. In both cases the outer integral part follows r2, so that neither r2 "
        "nor u jumps when the cascade returns.",
        "Changes: gains, integral and derivative times and weights b may be changed between two calls, and u does not "
        "jump. The limits may be changed too. Change Ts and filter times only with a restart, in manual at the present "
        "u.",
        "First call: r2 begins at y2, and u at manual_output in manual, at bias in automatic. With at_rest the loops "
        "are "
        "assumed to have been at rest at y1 = outer_y0, y2 = r2 = r2_bias, u = bias until then.",
    });
}

Expected<Program> feedforward_program(const SampledPid& feedback, const Feedforward& compensator, const CodeOptions& u,
                                      double d0) {
    const auto pid = part(feedback, u, "feedback");
    if (!pid) return pid.error();
    if (auto error = refused(compensator, feedback.Ts, "feedforward")) return *error;
    Composer whole("feedforward", "PID controller with feedforward", feedback.Ts);
    declare_signals(whole, "");
    const Expr d = whole.input("disturbance", "d, the measured disturbance");
    declare_output(whole, "");
    declare_sum(whole, u, "");
    const Expr rest = whole.setting("d0", d0, "d at the operating point"),
               before = whole.local("deviation_before", "deviation before the first call");
    whole.begin_with(assign(before, d - rest));
    whole.begin_with(when(whole["at_rest"], {assign(before, 0.0)}));
    whole.add(code::remark("The feedforward."));
    const Expr x = whole.let("deviation", "d from its operating point", d - rest),
               F = compensated(whole, "", compensator, x, before, feedback.Ts);
    add_to_controller(whole, *pid, "", whole.let("compensation", "what is added to the controller's output", -F));
    whole.add(assign(whole["u_before"], whole["u"]));
    std::vector<std::string> notes = notes_on_sum();
    notes.insert(
        notes.begin(),
        {"Feedforward: from the controller's output Kf (T_lead s + 1)/(T_lag s + 1) of d - d0 is subtracted, by "
         "backward Euler, after the dead time of " +
             text(compensator.Lf, 6) + " s. A lasting change of d by 1 moves u by -Kf.",
         note(*pid, PidNote::law), note(*pid, PidNote::windup),
         note(*pid, PidNote::changes) + " Change Kf, T_lead and T_lag while d is near d0, or in manual."});
    return whole.take(std::move(notes));
}

Expected<Program> level_program(const SampledPid& pid, const CodeOptions& u, double gap, double gap_gain) {
    const auto controller = part(pid, u, "");
    if (!controller) return controller;
    if (!(gap >= 0) || !std::isfinite(gap) || !(gap_gain >= 0 && gap_gain <= 1))
        return Error{ErrorKind::invalid_argument, "gap",
                     "gap is " + text(gap) + " and gap_gain " + text(gap_gain) +
                         "; gap must be >= 0, and gap_gain from 0 to 1."};
    Composer whole("level", "PID level controller", pid.Ts);
    declare_signals(whole, "");
    declare_output(whole, "");
    const Expr r = whole["setpoint"], y = whole["measurement"],
               width = whole.setting("gap", gap, "error within which only gap_gain of it counts; 0: none"),
               share = whole.setting("gap_gain", gap_gain, "share of the error that counts within the gap");
    whole.add(code::remark("The gap: of the error's part within it only a share counts."));
    const Expr error = whole.let("level_error", "r - y", r - y), inside = whole.local("inside", "its part in the gap");
    whole.add_bounded(inside, error, -width, width);
    whole.let("counted", "the measurement for the controller", r - (error - (1 - share) * inside));
    whole.embed(*controller, {{"measurement", "counted"}});
    std::vector<std::string> notes = controller->notes;
    notes.insert(
        notes.begin(),
        "Gap: while the level is within gap of the set point the controller sees gap_gain of the error, so that u "
        "rests. Outside it sees the error less (1 - gap_gain) gap: there is no step at the edge. In the law below "
        "y is the measurement that gives this error.");
    return whole.take(std::move(notes));
}

Expected<Program> interaction_program(const std::vector<SampledPid>& controllers, const std::vector<CodeOptions>& u,
                                      const Decoupling& elements) {
    const std::size_t n = controllers.size();
    const double Ts = controllers.front().Ts;
    const auto number = [](std::size_t i) { return std::to_string(i + 1); };
    Composer whole("loops", "PID group for interacting loops", Ts);
    std::vector<Program> programs;
    for (std::size_t i = 0; i < n; ++i) {
        auto program = part(controllers[i], u[i], "controllers/" + std::to_string(i));
        if (!program) return program;
        programs.push_back(std::move(*program));
        declare_signals(whole, "_" + number(i));
    }
    for (std::size_t i = 0; i < n; ++i) declare_output(whole, "_" + number(i));
    std::vector<std::string> notes{
        "Loops: controller i acts on measurement_i and moves u_i. The numbers at the end of names are those of the "
        "loops; "
        "Ts, at_rest and restart are for all. Each loop may be in manual by itself."};
    for (std::size_t i = 0; i < n; ++i)
        notes.push_back("Loop " + number(i) + ". " + note(programs[i], PidNote::law) + " " +
                        note(programs[i], PidNote::windup));
    notes.push_back(note(programs[0], PidNote::changes));
    if (elements.empty()) {
        for (const PidNote which : {PidNote::limits, PidNote::manual, PidNote::start})
            notes.push_back(note(programs[0], which));
        for (std::size_t i = 0; i < n; ++i) whole.embed(programs[i], {}, "", "_" + number(i));
        return whole.take(std::move(notes));
    }
    for (std::size_t i = 0; i < n; ++i) declare_sum(whole, u[i], "_" + number(i));
    for (std::size_t i = 0; i < n; ++i) {
        Expr sum = 0.0;
        for (std::size_t j = 0; i < elements.size() && j < elements[i].size(); ++j) {
            if (!elements[i][j]) continue;
            if (auto error = refused(*elements[i][j], Ts, "decoupling/" + std::to_string(i) + "/" + std::to_string(j)))
                return *error;
            const std::string s = "_" + number(i) + number(j);
            whole.add(code::remark("From u_" + number(j) + " to u_" + number(i) + "."));
            const Expr x = whole.let("deviation" + s, "u of the other loop from its operating point",
                                     whole["u_before_" + number(j)] - whole["bias_" + number(j)]);
            sum = sum + compensated(whole, s, *elements[i][j], x, 0.0, Ts, Ts);
        }
        whole.let("added_" + number(i), "what is added to the controller's output", sum);
    }
    for (std::size_t i = 0; i < n; ++i)
        add_to_controller(whole, programs[i], "_" + number(i), whole["added_" + number(i)]);
    for (std::size_t i = 0; i < n; ++i) whole.add(assign(whole["u_before_" + number(i)], whole["u_" + number(i)]));
    notes.emplace_back(
        "Decoupling: to controller i's output comes Kf_ij (T_lead_ij s + 1)/(T_lag_ij s + 1) of u_j - bias_j, by "
        "backward "
        "Euler, after the dead time. u_j is that of the last call, as limits or manual have left it; this call counts "
        "as "
        "a part of the dead time.");
    for (std::string& sentence : notes_on_sum()) notes.push_back(std::move(sentence));
    return whole.take(std::move(notes));
}

}  // namespace tunewright::structure
