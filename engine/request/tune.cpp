#include "engine/request/tune.h"

#include <algorithm>
#include <mutex>
#include <numeric>
#include <span>
#include <tuple>

#include "engine/evaluation/best_so_far.h"
#include "engine/evaluation/evaluate.h"
#include "engine/evaluation/evaluation_start.h"
#include "engine/request/identified_region.h"
#include "engine/request/own_step/own_steps.h"
#include "engine/request/plan.h"
#include "engine/request/ranking.h"
#include "engine/request/replay/replay.h"
#include "engine/request/rows.h"
#include "engine/request/ultimate_alone.h"
#include "engine/request/verdict/verdict.h"

namespace tunewright {
namespace {

constexpr double kIdentifyShare = 0.3;  // share of the progress, with a record
constexpr double kRowsShare = 0.3;      // share of the remaining progress, if optima are computed for every row

Error cancelled() { return {ErrorKind::cancelled, "", "The job was cancelled before a design was found."}; }

// One run of tune(): the state that its steps share.
class TuningRun {
public:
    TuningRun(const TuningRequest& request, const RunControl& control) : request_(request), control_(control) {}

    Expected<TuningResult> result();

private:
    class RowsProgress;

    std::optional<Error> find_plant();
    std::optional<Error> take_record();
    std::optional<Error> take_model(IdentifiedModel model);
    void state_problem();
    bool repeats(const TuningEntry& entry) const;
    bool tune_rows(const std::vector<PlannedRow>& planned, double from, double to);
    void judge_given();
    bool wants_optima() const;
    void compare_with_optima(double from);
    void replay_record();
    const device::DeviceModel* device_of(const TuningEntry& entry) const;
    void keep_best(const TuningEntry& entry);
    RunControl share(double from, double to) const;
    void report(double fraction, const std::string& stage, const std::string& message) const;
    void report_better(Progress progress) const;
    RankingTerms terms() const { return ranking_terms(request_.evaluate, subject_->linear() != nullptr); }
    bool stopped() const { return control_.stop.stop_requested(); }

    const TuningRequest& request_;
    const RunControl& control_;
    std::optional<AnalysedPlant> subject_;  // the plant that every controller is evaluated on
    std::optional<PlantFamily> held_;       // the plants on which limits must hold, if there are several
    std::optional<double> dead_time_std_;
    std::optional<TuningProblem> problem_;  // the input of the methods, unless the plant is known by points alone
    std::shared_ptr<const BestSoFar> best_;
    std::optional<Rows> rows_;
    TuningResult result_;
};

void TuningRun::report(double fraction, const std::string& stage, const std::string& message) const {
    if (control_.progress) control_.progress({fraction, stage, message, best_});
}

// Reports the progress with the better of its best design and the best one so far.
void TuningRun::report_better(Progress progress) const {
    if (best_ && !(progress.best && progress.best->load_IAE < best_->load_IAE)) progress.best = best_;
    control_.progress(progress);
}

// Gives a part of the work the range `from` to `to` of the progress.
RunControl TuningRun::share(double from, double to) const {
    RunControl part = control_;
    if (!control_.progress) return part;
    part.progress = [this, from, to](Progress inner) {
        inner.fraction = from + (to - from) * std::clamp(inner.fraction, 0.0, 1.0);
        report_better(std::move(inner));
    };
    return part;
}

std::optional<Error> TuningRun::take_record() {
    report(0, "identify", "Fitting models to the record.");
    auto model = identify(*request_.record, request_.identify, share(0, kIdentifyShare));
    if (!model) return model.error();
    return take_model(std::move(*model));
}

std::optional<Error> TuningRun::take_model(IdentifiedModel model) {
    if (request_.identified_region == IdentifiedRegion::held) {
        auto region = identified_region(model);
        if (!region) return placed(request_, region.error(), "");
        held_ = std::move(*region);
    }
    auto subject = subject_of(model);
    if (!subject) return placed(request_, subject.error(), "");
    subject_ = std::move(*subject);
    if (const auto at = model.standard_errors.find("L"); at != model.standard_errors.end()) dead_time_std_ = at->second;
    result_.model = std::move(model);
    return std::nullopt;
}

std::optional<Error> TuningRun::find_plant() {
    if (request_.record) return take_record();
    if (request_.model) return take_model(*request_.model);
    subject_ = request_.subject;
    if (subject_->family() != nullptr) held_ = *subject_->family();
    if (subject_->equations() != nullptr) result_.operating_point = operating_point(*subject_->equations());
    return std::nullopt;
}

void TuningRun::state_problem() {
    const LinearPlant* linear = subject_->linear();
    if (linear == nullptr) return;
    problem_ = TuningProblem{*subject_->nominal(), *linear, dead_time_std_, held_};
    problem_->nonlinear = subject_->equations();
    if (result_.model && result_.model->limit_cycle)
        problem_->relay_point = result_.model->limit_cycle->describing_function;
}

void TuningRun::keep_best(const TuningEntry& entry) {
    if (!entry.evaluation) return;
    const auto& [robustness, load] = std::tie(entry.evaluation->robustness, entry.evaluation->performance.load);
    if (!robustness.stable || !load.IAE || !robustness.Ms || *robustness.Ms > terms().rank_Ms) return;
    if (best_ && best_->load_IAE <= *load.IAE) return;
    best_ = std::make_shared<const BestSoFar>(
        BestSoFar{entry.evaluation->controller, *load.IAE, *robustness.Ms, robustness.Mt.value_or(0)});
}

// If a rule has no derivative, its PID row repeats its PI row.
bool TuningRun::repeats(const TuningEntry& entry) const {
    const IdealPid* pid = entry.evaluation ? std::get_if<IdealPid>(&entry.evaluation->controller) : nullptr;
    return pid != nullptr && std::ranges::any_of(result_.controllers, [&](const TuningEntry& other) {
               if (other.method != entry.method || !other.evaluation) return false;
               const IdealPid* known = std::get_if<IdealPid>(&other.evaluation->controller);
               return known != nullptr && *known == *pid;
           });
}

// The progress of all rows together, which may run at the same time.
class TuningRun::RowsProgress {
public:
    RowsProgress(TuningRun& run, std::size_t rows, double from, double to)
        : run_(run), done_(rows, 0.0), from_(from), to_(to) {}

    RunControl of(std::size_t row) {
        RunControl control = run_.control_;
        if (control.progress) control.progress = [this, row](Progress inner) { report(row, std::move(inner)); };
        return control;
    }
    void begin(std::size_t row, const std::string& title) {
        if (run_.control_.progress) report(row, {0, "tune", "Tuning with " + title + ".", nullptr});
    }
    void end(std::size_t row, const MadeRow& made) {
        const std::lock_guard locked(lock_);
        done_[row] = 1;
        for (const TuningEntry& entry : made.entries) run_.keep_best(entry);
    }

private:
    void report(std::size_t row, Progress inner) {
        const std::lock_guard locked(lock_);
        done_[row] = std::max(done_[row], std::clamp(inner.fraction, 0.0, 1.0));
        const double sum = std::accumulate(done_.begin(), done_.end(), 0.0);
        inner.fraction = from_ + (to_ - from_) * sum / static_cast<double>(done_.size());
        run_.report_better(std::move(inner));
    }

    TuningRun& run_;
    std::mutex lock_;
    std::vector<double> done_;  // fraction done of each row
    const double from_, to_;
};

// False if it was stopped before the last row.
bool TuningRun::tune_rows(const std::vector<PlannedRow>& planned, double from, double to) {
    RowsProgress progress(*this, planned.size(), from, to);
    std::vector<std::optional<MadeRow>> made(planned.size());
    parallel_for(control_.spread, static_cast<int>(planned.size()), [&](int index) {
        if (stopped()) return;
        const auto row = static_cast<std::size_t>(index);
        progress.begin(row, planned[row].title());
        made[row] = rows_->of(planned[row], progress.of(row));
        progress.end(row, *made[row]);
    });
    bool whole = true;
    for (std::size_t row = 0; row < planned.size(); ++row) {
        const bool answered = made[row] && !made[row]->cancelled();
        whole = whole && answered && !made[row]->partial;
        if (!answered) continue;
        for (TuningEntry& entry : made[row]->entries)
            if (!planned[row].of_all || !repeats(entry)) result_.controllers.push_back(std::move(entry));
    }
    return whole;
}

// Adds the entries of the controllers that the request gives.
void TuningRun::judge_given() {
    for (std::size_t index = 0; index < request_.controllers.size(); ++index) {
        if (stopped()) {
            result_.partial = true;
            return;
        }
        result_.controllers.push_back(rows_->given(index, control_));
        keep_best(result_.controllers.back());
    }
}

// Fills the column "distance from the optimum at the same Ms".
void TuningRun::compare_with_optima(double from) {
    RobustOptima optima(*problem_, on_linearisation(*subject_, request_.evaluate));
    const double share_of_one = (1 - from) / static_cast<double>(result_.controllers.size());
    for (TuningEntry& entry : result_.controllers) {
        if (stopped()) {
            result_.partial = true;
            return;
        }
        report(from, "tune", "Looking for the optimum at the same Ms as " + entry.title + ".");
        if (entry.evaluation) entry.optimum_at_Ms = optima.compare_at_Ms(*entry.evaluation, control_);
        from += share_of_one;
    }
}

// Replays the recorded time with the controller of each entry.
void TuningRun::replay_record() {
    if (!request_.record || result_.partial) return;
    const RecordReplayer replayer(request_, *result_.model);
    auto& entries = result_.controllers;
    parallel_for(control_.spread, static_cast<int>(entries.size()), [&](int index) {
        TuningEntry& entry = entries[static_cast<std::size_t>(index)];
        if (!stopped()) entry.replay = replayer.of(entry);
    });
    result_.replay = replayer.record();
}

// Given settings may be those of a product of their own.
const device::DeviceModel* TuningRun::device_of(const TuningEntry& entry) const {
    const GivenController* given = entry.is_baseline() ? &*request_.baseline : nullptr;
    if (entry.method == kGivenMethod) {
        const auto before = std::span(result_.controllers.data(), &entry);
        given =
            &request_
                 .controllers[static_cast<std::size_t>(std::ranges::count(before, kGivenMethod, &TuningEntry::method))];
    }
    if (given != nullptr && given->typed) return &given->typed->device;
    return request_.device ? &*request_.device : nullptr;
}

// Optima are needed if several designs are ranked, because they are ranked by their distance from them.
bool TuningRun::wants_optima() const {
    const bool several = request_.tune.size() > 1 || (!request_.tune.empty() && request_.tune.front().of_all());
    return problem_ && request_.evaluate.optimum_at_Ms.value_or(several);
}

Expected<TuningResult> TuningRun::result() {
    auto planned = plan_rows(request_.tune);
    if (!planned) return planned.error();
    const std::size_t entries = planned->size() + request_.controllers.size() + request_.baseline.has_value();
    if (const auto error = refuse_traces(request_.evaluate, entries)) return *error;
    if (request_.own_step)
        if (const auto error = refuse_own_step(*request_.own_step)) return *error;
    if (const auto error = find_plant()) return *error;
    state_problem();
    rows_.emplace(request_, *subject_, problem_, result_.model ? &*result_.model : nullptr);
    if (!problem_ || !problem_->nonlinear)
        std::erase_if(*planned, [](const PlannedRow& row) { return row.of_all && row.method->all_if_nonlinear; });

    const double start = result_.model ? kIdentifyShare : 0;
    const double tuned = wants_optima() ? start + (1 - start) * kRowsShare : 1;
    if (!tune_rows(*planned, start, tuned)) result_.partial = true;
    judge_given();
    const bool found =
        std::ranges::any_of(result_.controllers, [](const TuningEntry& e) { return e.evaluation.has_value(); });
    if (!found) return result_.partial ? cancelled() : all_failed(result_.controllers);
    if (request_.baseline) {
        if (stopped())
            result_.partial = true;
        else
            result_.controllers.push_back(rows_->baseline(control_));
    }
    if (wants_optima() && !result_.partial) compare_with_optima(tuned);
    replay_record();
    if (!simulate_own_steps(
            result_.controllers, *subject_, request_.own_step, request_.evaluate.points,
            [this](const TuningEntry& entry) { return device_of(entry); }, control_))
        result_.partial = true;
    draw_together(result_.controllers);
    result_.ranking = ranked(result_.controllers, terms());
    if (result_.model && !result_.ranking.empty())
        result_.model->region = region_of(result_.controllers[static_cast<size_t>(result_.ranking.front())]);
    result_.ranking_by = ranking_by(result_.controllers, terms());
    result_.rank_Ms = terms().rank_Ms;
    const verdict::Context context{*subject_,
                                   request_.evaluate,
                                   request_.labels,
                                   request_.device ? request_.device->Ts : 0,
                                   result_.model ? &*result_.model : nullptr,
                                   problem_ ? &*problem_ : nullptr,
                                   request_.given_steps,
                                   control_,
                                   request_.own_step ? &*request_.own_step : nullptr};
    verdict::judge(result_.controllers, context);
    result_.verdict = verdict::of_all(result_.controllers, result_.ranking, context, result_.partial);
    result_.proposed = verdict::proposed(result_.controllers, result_.verdict);
    report(1, "tune", "Done.");
    return std::move(result_);
}

}  // namespace

Expected<TuningResult> tune(const TuningRequest& request, const RunControl& control) {
    const int given = request.subject.has_value() + request.record.has_value() + request.model.has_value() +
                      request.ultimate.has_value();
    if (given != 1)
        return Error{ErrorKind::invalid_argument, "",
                     given > 1 ? "The request gives more than one of plant, record, model and ultimate; give exactly "
                                 "one."
                               : "The request gives none of plant, record, model and ultimate; give exactly one."};
    if (request.tune.empty() && request.controllers.empty())
        return Error{ErrorKind::invalid_argument, "tune", "tune is empty; give at least one method, such as robust."};
    if (request.ultimate) return tune_on_ultimate(request);
    return TuningRun(request, control).result();
}

}  // namespace tunewright
