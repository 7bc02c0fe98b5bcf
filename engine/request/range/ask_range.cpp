#include "engine/request/range/ask_range.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/number_text.h"
#include "engine/plant/linear/linear_plant.h"
#include "engine/range/run/profile.h"
#include "engine/request/range/plants_of.h"

namespace tunewright {
namespace {

using range::RangeDesign;
using range::Verdict;

constexpr double kIdentified = 0.3, kDesigned = 0.9;  // shares of the progress, with records and with runs
constexpr std::size_t kRunSamples = 401;

/// Gives a part of the work the range `from` to `to` of the progress.
RunControl share_of(const RunControl& control, double from, double to) {
    RunControl part{.stop = control.stop, .progress = {}, .now_ms = control.now_ms};
    if (control.progress)
        part.progress = [&control, from, to](Progress progress) {
            progress.fraction = from + (to - from) * std::clamp(progress.fraction, 0.0, 1.0);
            control.progress(progress);
        };
    return part;
}

verdict::Finding finding_of(const RangeDesign& design) {
    const bool needed = !design.one;
    const char* code = needed                                   ? "schedule-needed"
                       : design.verdict == Verdict::one_setting ? "one-setting"
                       : design.verdict == Verdict::optional    ? "schedule-optional"
                                                                : "schedule-pays";
    const verdict::Level level = design.verdict == Verdict::one_setting ? verdict::Level::good
                                 : design.verdict == Verdict::optional  ? verdict::Level::note
                                                                        : verdict::Level::warning;
    verdict::FindingBuilder draft(code, level);
    draft.say(design.because);
    const auto figure = [&draft](const char* name, double value) {
        if (std::isfinite(value)) draft.figure(name, value);
    };
    if (design.one)
        figure("one_worst_relative_IAE", design.one_curve.places.empty() ? design.one->worst_relative_IAE
                                                                         : largest_relative_IAE(design.one_curve));
    if (design.schedule) {
        figure("schedule_worst_relative_IAE", design.schedule->worst_relative_IAE);
        figure("rows", double(design.schedule->schedule.rows.size()));
    }
    return draft;
}

/// The finding on a schedule that was given: if it keeps the limits, and its cost.
verdict::Finding finding_of_given(const range::ScheduleDesign& given) {
    using verdict::FindingBuilder, verdict::Level;
    const bool one = given.schedule.rows.size() == 1;
    const std::size_t rows = given.schedule.rows.size();
    FindingBuilder draft = !given.holds_limits      ? FindingBuilder("schedule-exceeds", Level::bad)
                           : given.within_allowance ? FindingBuilder("schedule-holds", Level::good)
                                                    : FindingBuilder("schedule-costs", Level::warning);
    draft.say(given.holds_limits ? (one ? "This " : "These ") : (one ? "With this " : "With these "))
        .say(one ? "row" : std::to_string(rows) + " rows")
        .figure("rows", double(rows));
    if (!given.holds_limits)
        draft.say(" the limits do not hold everywhere in the range.");
    else if (given.within_allowance)
        draft.say(std::string(one ? " holds" : " hold") + " the limits everywhere, within the allowance.");
    else
        draft.say(std::string(one ? " holds" : " hold") + " the limits, but " + (one ? "costs" : "cost") +
                  " more than the allowance.");
    if (!std::isfinite(given.worst_relative_IAE)) return draft;
    if (!given.holds_limits) return draft.figure("schedule_worst_relative_IAE", given.worst_relative_IAE);
    return draft.say(" The IAE is at most ")
        .number("schedule_worst_relative_IAE", given.worst_relative_IAE)
        .say(" times each operating point's own optimum.");
}

/// Moves an error's place from the options to the schedule of the request.
Error in_words_of_question(Error error) {
    if (error.where.starts_with("options/")) error.where = "schedule/" + error.where.substr(8);
    return error;
}

class RangeAsked {
public:
    RangeAsked(const RangeQuestion& question, const RunControl& control) : question_(question), control_(control) {}

    Expected<RangeResult> answer() {
        const double started = control_.now_ms ? control_.now_ms() : 0;
        if (auto error = find_model()) return in_range_request(*error, question_);
        if (auto error = design()) return in_range_request(in_words_of_question(*error), question_);
        if (auto error = look_at_places()) return *error;
        if (auto error = run_across()) return *error;
        if (control_.now_ms) result_.compute_ms = control_.now_ms() - started;
        report_progress("The range is complete.");
        return std::move(result_);
    }

private:
    bool stopped() const { return control_.stop.stop_requested(); }

    void report_progress(const char* message) const {
        if (control_.progress) control_.progress({.fraction = 1, .stage = "evaluate", .message = message, .best = {}});
    }

    bool has_records() const {
        return std::ranges::any_of(question_.points,
                                   [](const auto& point) { return std::holds_alternative<Record>(point.content); });
    }

    std::optional<Error> find_model() {
        result_.scheduling = question_.scheduling;
        Expected<std::shared_ptr<const range::RangeModel>> model = Error{};
        if (question_.branch) {
            model = model_of_branch(question_.branch);
        } else {
            std::vector<range::RangePoint> points;
            auto plants = plants_of(question_, share_of(control_, 0, kIdentified), points, warnings_);
            if (!plants) return plants.error();
            result_.points = std::move(*plants);
            model = model_of_points(points, question_.options.between);
        }
        if (!model) return model.error();
        model_ = *model;
        result_.low = model_->low();
        result_.high = model_->high();
        if (!question_.branch) return std::nullopt;
        for (const double at : model_->points()) {
            const auto state = question_.branch->at(at);
            if (!state) return state.error();
            result_.points.push_back(
                {.at = at, .plant = question_.branch->linearised(*state), .model = {}, .u = state->u, .y = state->y});
        }
        return std::nullopt;
    }

    std::optional<Error> design() {
        const range::RangeProblem problem{.scheduling = question_.scheduling,
                                          .model = model_,
                                          .options = question_.options,
                                          .hold_between = question_.branch != nullptr};
        const double from = has_records() ? kIdentified : 0, to = runs() ? kDesigned : 1;
        result_.given = !question_.given.empty();
        const RunControl part = share_of(control_, from, to);
        auto found = result_.given ? judge_schedule(problem, given(), part) : design_range(problem, part);
        if (!found) return found.error();
        result_.design = std::move(*found);
        result_.design.warnings.insert(result_.design.warnings.begin(), warnings_.begin(), warnings_.end());
        result_.verdict = result_.given ? finding_of_given(*result_.design.schedule) : finding_of(result_.design);
        return std::nullopt;
    }

    Schedule given() const {
        const bool steps = question_.options.interpolation == Interpolation::steps;
        return {.interpolation = question_.options.interpolation,
                .hysteresis = steps ? question_.options.hysteresis * (model_->high() - model_->low()) : 0,
                .rows = question_.given};
    }

    std::optional<Error> look_at_places() {
        const auto& one = result_.design.one_curve.places;
        for (const range::PointFigures& figures : one.empty() ? result_.design.schedule_curve.places : one) {
            const auto model = model_->at(figures.at);
            if (!model) return model.error();
            RangePlace place{.at = figures.at, .K = {}, .T = {}, .L = {}, .u = model->u, .y = model->y};
            if (model->nominal) {
                place.K = model->nominal->low_frequency_gain();
                place.T = model->nominal->lag_sum();
                place.L = model->nominal->dead_time();
            }
            result_.places.push_back(place);
        }
        return std::nullopt;
    }

    bool runs() const { return question_.branch && question_.runs; }

    std::optional<Error> run_across() {
        const RangeDesign& design = result_.design;
        if (!runs() || !design.schedule || stopped()) return std::nullopt;
        auto passages = standard_passages(*question_.branch, design.schedule->schedule);
        if (!passages) return passages.error();
        for (range::Passage& passage : *passages) {
            if (stopped()) {
                result_.design.partial = true;
                return std::nullopt;
            }
            range::RunOptions options;
            options.horizon = passage.horizon;
            options.samples = kRunSamples;
            options.stop = control_.stop;
            RangePassage run{.passage = std::move(passage), .one = {}, .schedule = {}, .nonlinear = {}};
            auto scheduled = run_schedule(*question_.branch, design.schedule->schedule, run.passage.profile, options);
            if (!scheduled) return scheduled.error();
            run.schedule = std::move(*scheduled);
            if (design.one) {
                auto plain = run_schedule(*question_.branch, range::one_row(design.one->controller, result_.low),
                                          run.passage.profile, options);
                if (!plain) return plain.error();
                run.one = std::move(*plain);
            }
            auto nonlinear =
                run_linearising(*question_.branch, design.schedule->schedule, run.passage.profile, options);
            if (nonlinear)
                run.nonlinear = std::move(*nonlinear);
            else
                run.nonlinear.why = nonlinear.error().message;
            result_.runs.push_back(std::move(run));
        }
        return std::nullopt;
    }

    const RangeQuestion& question_;
    const RunControl& control_;
    std::shared_ptr<const range::RangeModel> model_;
    std::vector<Warning> warnings_;
    RangeResult result_;
};

}  // namespace

Error in_range_request(Error error, const RangeQuestion& question) {
    const std::string prefix = "points/", field = "/plant";
    if (!error.where.starts_with(prefix)) return error;
    const std::size_t end = error.where.find('/', prefix.size());
    if (end == std::string::npos || error.where.substr(end, field.size()) != field) return error;
    const auto k = std::size_t(std::stoul(error.where.substr(prefix.size(), end - prefix.size())));
    if (k < question.points.size() && std::holds_alternative<Record>(question.points[k].content))
        error.where = error.where.substr(0, end) + "/record";
    return error;
}

Expected<RangeResult> ask_range(const RangeQuestion& question, const RunControl& control) {
    return RangeAsked(question, control).answer();
}

}  // namespace tunewright
