#include "engine/code/algorithm.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string_view>
#include <utility>

#include "engine/code/builder.h"
#include "engine/number_text.h"

namespace tunewright::code {
namespace {

Error invalid(const char* where, const std::string& sentence) { return {ErrorKind::invalid_argument, where, sentence}; }

bool above_zero(double x) { return x > 0 && std::isfinite(x); }

std::optional<Error> timing_fault(const Plan& plan) {
    const double Ts = plan.pid.Ts, Tf = plan.pid.gains.filter.Tf;
    if (!above_zero(Ts)) return invalid("sample_time", "sample_time is " + text(Ts) + " s; it must be above 0.");
    if (plan.filter != FilterType::none && !above_zero(Tf))
        return invalid("controller/filter/Tf", "Tf is " + text(Tf) + "; it must be above 0.");
    if (plan.derivative && plan.rule == DerivativeRule::filtered_forward && !(Tf > Ts / 2))
        return invalid("derivative",
                       "derivative is filtered_forward, which is stable only for Tf above half the sample "
                       "time; Tf is " +
                           text(Tf) + " s and the sample time " + text(Ts) +
                           " s. Choose filtered_backward, or sample more often.");
    if (plan.derivative && plan.rule == DerivativeRule::slope &&
        !(plan.pid.slope_samples >= 1 && plan.pid.slope_samples <= kMaxSlopeSamples))
        return invalid("slope_samples", "slope_samples is " + std::to_string(plan.pid.slope_samples) +
                                            "; it must be 1 to " + std::to_string(kMaxSlopeSamples) + ".");
    return std::nullopt;
}

std::optional<Error> option_fault(const Plan& plan) {
    const CodeOptions& options = plan.options;
    const double u_min = options.u_min.value_or(-kNoLimit), u_max = options.u_max.value_or(kNoLimit);
    if (!(u_min < u_max))
        return invalid("u_max", "u_max is " + text(u_max) + " and u_min " + text(u_min) + "; u_max must be > u_min.");
    if (!(options.rate_limit >= 0) || !std::isfinite(options.rate_limit))
        return invalid("rate_limit", "rate_limit is " + text(options.rate_limit) + "; it must be >= 0.");
    if (options.tracking_time && !above_zero(*options.tracking_time))
        return invalid("tracking_time", "tracking_time is " + text(*options.tracking_time) + "; it must be above 0.");
    if (options.delta_r && !above_zero(*options.delta_r))
        return invalid("controller/delta_r", "delta_r is " + text(*options.delta_r) + "; it must be above 0.");
    if (options.delta_r && plan.smooths())
        return Error{ErrorKind::unsupported, "controller/filter",
                     "The nonlinear form has no filter of the measurement. Choose none or derivative."};
    if (!plan.position && !plan.integral)
        return Error{ErrorKind::unsupported, "form",
                     "form is velocity and the controller has no integral action: after a limit, u would not return to "
                     "its level. Choose position."};
    return std::nullopt;
}

}  // namespace

Expected<Program> pid_algorithm(const SampledPid& pid, const CodeOptions& options, bool follows_schedule) {
    const Plan plan{pid, options, follows_schedule};
    if (const auto fault = timing_fault(plan)) return *fault;
    if (const auto fault = option_fault(plan)) return *fault;
    return Builder(plan).build();
}

namespace {

/// The settings that a row gives and the program has, in this order.
struct FollowedSetting {
    const char* name;
    double ScheduleRow::*member;
};
constexpr std::array kFollowed = {FollowedSetting{"Kp", &ScheduleRow::Kp}, FollowedSetting{"Ti", &ScheduleRow::Ti},
                                  FollowedSetting{"Td", &ScheduleRow::Td}, FollowedSetting{"Tf", &ScheduleRow::Tf},
                                  FollowedSetting{"b", &ScheduleRow::b}};

Expr variable_of(VariableRole role, const char* name) {
    return Expr(Expression{Type::real, VariableReference{role, name}});
}

/// Puts the computation of the scheduled settings in front of the program's body.
class Following {
public:
    Following(Program& program, const Schedule& schedule) : program_(program), schedule_(schedule) {
        at_ = declare_input();
        for (const FollowedSetting& setting : kFollowed) take_over(setting);
    }

    void add() {
        body_.push_back(remark("The settings of this call, from the schedule."));
        schedule_.interpolation == Interpolation::steps ? add_steps() : add_lines();
        program_.body.insert(program_.body.begin(), body_.begin(), body_.end());
    }

private:
    /// Declares the input after the measurement and before the inputs of manual mode.
    Expr declare_input() {
        const Expr input = program_.declare({.role = VariableRole::input,
                                             .name = kSchedulingInput,
                                             .comment = "the scheduling variable, in the unit of the rows"});
        auto& all = program_.variables;
        const auto after = std::ranges::find(all, std::string("measurement"), &Declaration::name) + 1;
        std::rotate(after, all.end() - 1, all.end());
        return input;
    }

    /// Turns a setting of the user into a state of the program.
    void take_over(const FollowedSetting& setting) {
        for (Declaration& known : program_.variables)
            if (known.name == setting.name && known.role == VariableRole::parameter) {
                known.role = VariableRole::state;
                known.comment += ", as of the last call";
                followed_.push_back(setting);
            }
    }

    double value(const FollowedSetting& setting, std::size_t row) const {
        return std::abs(schedule_.rows[row].*setting.member);
    }

    Block row_as_it_is(std::size_t row) const {
        Block block;
        for (const FollowedSetting& setting : followed_)
            block.push_back(assign(variable_of(VariableRole::state, setting.name), value(setting, row)));
        return block;
    }

    void add_steps() {
        const double half = 0.5 * schedule_.hysteresis;
        const Expr row = program_.declare({.role = VariableRole::state,
                                           .type = Type::integer,
                                           .name = "schedule_row",
                                           .comment = "the row in use, from 0"});
        const std::size_t count = schedule_.rows.size();
        for (std::size_t k = 1; k < count; ++k)
            body_.push_back(
                when(both(row<whole(int(k)), at_> schedule_.rows[k].at + half), {assign(row, whole(int(k)))}));
        for (std::size_t k = count - 1; k > 0; --k)
            body_.push_back(
                when(both(row >= whole(int(k)), at_ < schedule_.rows[k].at - half), {assign(row, whole(int(k) - 1))}));
        const Block first = row_as_it_is(0);
        body_.insert(body_.end(), first.begin(), first.end());
        for (std::size_t k = 1; k < count; ++k) body_.push_back(when(row >= whole(int(k)), row_as_it_is(k)));
    }

    void add_lines() {
        const Block first = row_as_it_is(0);
        body_.insert(body_.end(), first.begin(), first.end());
        if (schedule_.rows.size() < 2) return;
        const Expr share = program_.declare(
            {.role = VariableRole::local, .name = "share", .comment = "fraction of the way to the next row: 0 to 1"});
        for (std::size_t k = 0; k + 1 < schedule_.rows.size(); ++k) {
            const double from = schedule_.rows[k].at, to = schedule_.rows[k + 1].at;
            Block part{assign(share, (at_ - from) / (to - from)), when(share > 1, {assign(share, 1.0)})};
            for (const FollowedSetting& setting : followed_)
                part.push_back(assign(variable_of(VariableRole::state, setting.name), between(setting, k, share)));
            body_.push_back(when(at_ > from, std::move(part)));
        }
    }

    Expr between(const FollowedSetting& setting, std::size_t k, const Expr& share) const {
        const double left = value(setting, k), right = value(setting, k + 1);
        if (schedule_.interpolation == Interpolation::linear_in_gains && std::string_view(setting.name) == "Ti")
            return 1 / (Expr(1 / left) + share * Expr(1 / right - 1 / left));
        return Expr(left) + share * Expr(right - left);
    }

    Program& program_;
    const Schedule& schedule_;
    Expr at_ = 0;
    std::vector<FollowedSetting> followed_;
    Block body_;
};

std::string how(const Schedule& schedule) {
    switch (schedule.interpolation) {
        case Interpolation::steps:
            return "a row's settings hold from its value on; a row is left " + text(0.5 * schedule.hysteresis) +
                   " beyond its border";
        case Interpolation::linear_in_gains: return "between rows Kp, 1/Ti, Td, Tf and b are linear";
        case Interpolation::linear_in_times: return "between rows Kp, Ti, Td, Tf and b are linear";
    }
    return {};
}

/// The error of rows that the program cannot follow: it has one action, and either a filter or none.
std::optional<Error> row_fault(const Schedule& schedule) {
    const auto same = [&](auto property) {
        return std::ranges::all_of(
            schedule.rows, [&](const ScheduleRow& row) { return property(row) == property(schedule.rows.front()); });
    };
    if (!same([](const ScheduleRow& row) { return row.Kp < 0; }))
        return Error{ErrorKind::unsupported, "rows",
                     "Kp of the rows changes its sign, and a program has one action. Write one program for each sign."};
    if (!same([](const ScheduleRow& row) { return row.Tf > 0; }))
        return Error{ErrorKind::unsupported, "rows",
                     "Some rows have a filter and others have Tf = 0. Give every row a Tf above 0, or none."};
    return std::nullopt;
}

std::string schedule_note(const Schedule& schedule, const std::string& named) {
    std::string note = "Schedule: each call computes its settings from the input " + std::string(kSchedulingInput) +
                       ", " + named + "; " + how(schedule) +
                       ", below the first and above the last row their settings hold. A change of settings does not "
                       "make u jump. Rows, times in s:";
    for (const ScheduleRow& row : schedule.rows)
        note += " at " + text(row.at, 6) + " Kp " + text(std::abs(row.Kp), 6) + ", Ti " + text(row.Ti, 6) + ", Td " +
                text(row.Td, 6) + ", Tf " + text(row.Tf, 6) + ", b " + text(row.b, 4) + ";";
    note.back() = '.';
    return note;
}

}  // namespace

const ScheduleRow& leading_row(const Schedule& schedule) {
    const bool derivative = std::ranges::any_of(schedule.rows, [](const ScheduleRow& row) { return row.Td > 0; });
    const ScheduleRow* best = nullptr;
    for (const ScheduleRow& row : schedule.rows)
        if ((!derivative || row.Td > 0) && (best == nullptr || row.Ti < best->Ti)) best = &row;
    return *best;
}

Expected<Program> scheduled_algorithm(const Schedule& schedule, const SampledPid& law, const CodeOptions& options,
                                      const std::string& named) {
    if (law.velocity)
        return Error{ErrorKind::unsupported, "form",
                     "The velocity form has no integral part, which bumpless changes of settings need. Choose the form "
                     "position."};
    if (const auto fault = row_fault(schedule)) return *fault;
    SampledPid leading = law;
    leading.gains = to_parallel(controller_of(leading_row(schedule)));
    auto program = pid_algorithm(leading, options, true);
    if (!program) return program;
    Following(*program, schedule).add();
    program->notes.insert(program->notes.begin(), schedule_note(schedule, named));
    return program;
}

}  // namespace tunewright::code
