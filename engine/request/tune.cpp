#include "engine/request/tune.h"

#include <algorithm>
#include <tuple>

#include "engine/evaluation/evaluate.h"
#include "engine/evaluation/longest_sample_time.h"
#include "engine/request/identified_region.h"
#include "engine/request/plan.h"
#include "engine/request/ranking.h"
#include "engine/request/verdict/verdict.h"
#include "engine/tuning/arrieta/tradeoff_report.h"
#include "engine/tuning/method/setpoint.h"

namespace tunewright {
namespace {

constexpr double kIdentifyShare = 0.3;  // of the progress, with a record
constexpr double kRowsShare = 0.3;      // of what then remains, where optima are computed for every row

Error cancelled() { return {ErrorKind::cancelled, "", "The job was cancelled before a design was found."}; }

bool in_plant(const Error& error) { return error.where == "plant" || error.where.starts_with("plant/"); }

// One run of tune(): what its steps share.
class TuningRun {
public:
    TuningRun(const TuningRequest& request, const RunControl& control) : request_(request), control_(control) {}

    Expected<TuningResult> result();

private:
    std::optional<Error> find_plant();
    std::optional<Error> take_record();
    void state_problem();
    Expected<TunedController> tuned_with(const PlannedRow& planned, const SetpointOptions& setpoint,
                                         const RunControl& control, std::optional<built::Fitted>& fitted) const;
    void add_as_built(TuningEntry& entry, std::optional<built::Fitted> fitted, const RunControl& control);
    void add_baseline_as_built(TuningEntry& entry);
    TuningEntry entry(const PlannedRow& planned, double from, double to);
    std::vector<TuningEntry> entries(const PlannedRow& planned, double from, double to);
    bool repeats(const TuningEntry& entry) const;
    bool tune_rows(const std::vector<PlannedRow>& planned, double from, double to);
    bool wants_optima() const;
    void compare_with_optima(double from);
    TuningEntry baseline();
    Expected<Evaluation> evaluated(const Controller& controller);
    void evaluate_into(TuningEntry& entry, const Controller& controller, std::vector<Warning> warnings);
    void add_reports(TuningEntry& entry, std::shared_ptr<MethodReport> own);
    Error placed(Error error, const std::string& where) const;
    void keep_best(const TuningEntry& entry);
    RunControl share(double from, double to) const;
    void report(double fraction, const std::string& stage, const std::string& message) const;
    double now_ms() const { return control_.now_ms ? control_.now_ms() : 0; }
    bool stopped() const { return control_.stop.stop_requested(); }

    const TuningRequest& request_;
    const RunControl& control_;
    std::optional<Subject> subject_;   // what every controller is judged on
    std::optional<PlantFamily> held_;  // where limits must hold, if that is more than one plant
    std::optional<double> dead_time_std_;
    std::optional<TuningProblem> problem_;  // what methods work on, unless the plant is known by points alone
    std::optional<BestSoFar> best_;
    std::optional<Tradeoffs> tradeoffs_;  // made when first asked for
    std::vector<std::pair<IdealPid, Evaluation>> evaluated_;
    TuningResult result_;
};

void TuningRun::report(double fraction, const std::string& stage, const std::string& message) const {
    if (control_.progress) control_.progress({fraction, stage, message, best_});
}

// A part of the work sees 0 to 1 as its own; the better of its best design and ours is reported.
RunControl TuningRun::share(double from, double to) const {
    RunControl part{control_.stop, nullptr, control_.now_ms};
    if (!control_.progress) return part;
    part.progress = [this, from, to](const Progress& inner) {
        Progress outer = inner;
        outer.fraction = from + (to - from) * std::clamp(inner.fraction, 0.0, 1.0);
        if (best_ && !(outer.best && outer.best->load_IAE < best_->load_IAE)) outer.best = best_;
        control_.progress(outer);
    };
    return part;
}

std::optional<Error> TuningRun::take_record() {
    report(0, "identify", "Fitting models to the record.");
    auto model = identify(*request_.record, request_.identify, share(0, kIdentifyShare));
    if (!model) return model.error();
    auto region = identified_region(*model);
    if (!region && request_.identified_region == IdentifiedRegion::held) return region.error();
    auto subject = Subject::of_family(region ? *region : family_of(model->plant));
    if (!subject) return placed(subject.error(), "");
    subject_ = std::move(*subject);
    if (request_.identified_region == IdentifiedRegion::held) held_ = *region;
    if (const auto at = model->standard_errors.find("L"); at != model->standard_errors.end())
        dead_time_std_ = at->second;
    result_.model = std::move(*model);
    return std::nullopt;
}

std::optional<Error> TuningRun::find_plant() {
    if (request_.subject.has_value() == request_.record.has_value())
        return Error{ErrorKind::invalid_argument, "",
                     request_.subject ? "Both plant and record are given; give one of them."
                                      : "Neither plant nor record is given; give one of them."};
    if (request_.record) return take_record();
    subject_ = request_.subject;
    if (subject_->family() != nullptr) held_ = *subject_->family();
    if (subject_->equations() != nullptr) result_.operating_point = operating_point(*subject_->equations());
    return std::nullopt;
}

// Methods name an option or a field of the plant; the request has the one under the method's place, and the other only
// if it gave a plant.
Error TuningRun::placed(Error error, const std::string& where) const {
    if (in_plant(error)) {
        if (request_.record) error.where = "record";
    } else if (!error.where.empty()) {
        error.where = where + "/" + error.where;
    }
    return error;
}

// Several rules may give the very same controller: it is evaluated once.
Expected<Evaluation> TuningRun::evaluated(const Controller& controller) {
    const IdealPid* pid = std::get_if<IdealPid>(&controller);
    if (pid != nullptr)
        for (const auto& [known, evaluation] : evaluated_)
            if (known == *pid) return evaluation;
    auto evaluation = evaluate(*subject_, controller, request_.evaluate);
    if (evaluation && pid != nullptr) evaluated_.emplace_back(*pid, *evaluation);
    return evaluation;
}

void TuningRun::evaluate_into(TuningEntry& entry, const Controller& controller, std::vector<Warning> warnings) {
    auto evaluation = evaluated(controller);
    if (!evaluation) {
        entry.error = evaluation.error();
        return;
    }
    warnings.insert(warnings.end(), evaluation->warnings.begin(), evaluation->warnings.end());
    evaluation->warnings = std::move(warnings);
    entry.evaluation = std::move(*evaluation);
}

// The method's own, completed, and what was asked for of every controller.
void TuningRun::add_reports(TuningEntry& entry, std::shared_ptr<MethodReport> own) {
    if (!entry.evaluation || !(own || request_.evaluate.tradeoff)) return;
    if (!tradeoffs_) tradeoffs_.emplace(subject_->nominal(), request_.evaluate);
    if (own) {
        own->complete({*subject_, request_.evaluate, *tradeoffs_}, *entry.evaluation);
        entry.reports.push_back(std::move(own));
    }
    if (request_.evaluate.tradeoff && entry.report_as<TradeoffReport>() == nullptr)
        entry.reports.push_back(
            std::make_shared<TradeoffReport>(tradeoffs_->of(entry.evaluation->controller, entry.reduced_model)));
}

void TuningRun::state_problem() {
    const LinearPlant* linear = subject_->linear();
    if (linear == nullptr) return;
    problem_ = TuningProblem{*subject_->nominal(), *linear, dead_time_std_, held_};
    problem_->nonlinear = subject_->equations();
    if (result_.model && result_.model->limit_cycle)
        problem_->relay_point = result_.model->limit_cycle->describing_function;
}

// `fitted`: the settings, where the method designs for the controller as it is built.
Expected<TunedController> TuningRun::tuned_with(const PlannedRow& planned, const SetpointOptions& setpoint,
                                                const RunControl& control, std::optional<built::Fitted>& fitted) const {
    const TuningMethod& method = *planned.method;
    const MethodOptions& options = planned.options;
    if (planned.refusal) return *planned.refusal;
    if (problem_ && request_.implement && method.tune_as_built) {
        auto design = method.tune_as_built(*problem_, options, *request_.implement, control);
        if (!design) return design.error();
        fitted = std::move(design->fitted);
        weigh_setpoint(*fitted, *request_.implement, problem_->linear, setpoint, design->tuned);
        return std::move(design->tuned);
    }
    if (problem_) {
        auto tuned = method.tune(*problem_, options, control);
        if (tuned) weigh_setpoint(problem_->linear, setpoint, *tuned);
        return tuned;
    }
    if (method.tune_on_points) return method.tune_on_points(*subject_->measured(), options, control);
    return Error{ErrorKind::unsupported, "",
                 "The method " + method.id +
                     " needs a model of the plant; points of a frequency response serve the method robust."};
}

void TuningRun::add_as_built(TuningEntry& entry, std::optional<built::Fitted> fitted, const RunControl& control) {
    if (!request_.implement || !entry.evaluation) return;
    const built::Build& build = *request_.implement;
    Evaluation& ideal = *entry.evaluation;
    take_as_built(fitted ? judge_as_built(*subject_, build, std::move(*fitted), request_.evaluate, ideal)
                         : built_from(*subject_, build, request_.evaluate, ideal, control),
                  ideal, entry.as_built);
}

// Settings that were given as typed are judged as they stand, whatever the others are made for.
void TuningRun::add_baseline_as_built(TuningEntry& entry) {
    if (!request_.baseline_settings || !entry.evaluation) return add_as_built(entry, std::nullopt, control_);
    const auto& [build, settings] = *request_.baseline_settings;
    auto fitted = built::fit(build, settings);
    Evaluation& ideal = *entry.evaluation;
    take_as_built(fitted ? judge_as_built(*subject_, build, std::move(*fitted), request_.evaluate, ideal)
                         : Expected<AsBuilt>(fitted.error()),
                  ideal, entry.as_built);
}

TuningEntry TuningRun::entry(const PlannedRow& planned, double from, double to) {
    TuningEntry entry;
    entry.method = planned.method->id;
    entry.title = planned.title;
    entry.source = planned.method->source;
    const auto& on_points = planned.method->options_on_points;
    entry.options = with_defaults(problem_ || on_points.empty() ? planned.method->options : on_points, planned.options);
    const SetpointOptions setpoint = problem_ ? wanted_setpoint(*planned.method, entry.options) : SetpointOptions{};
    const double started = now_ms();
    std::optional<built::Fitted> fitted;
    auto tuned = tuned_with(planned, setpoint, share(from, to), fitted);
    if (!tuned) {
        entry.error = placed(tuned.error(), planned.where);
        return entry;
    }
    entry.reduced_model = tuned->reduced_model;
    entry.Ms_limit = tuned->Ms_limit;
    if (planned.Ms_asked) entry.asked_Ms = tuned->Ms_limit;
    result_.partial = result_.partial || tuned->partial;
    evaluate_into(entry, controller_of(*tuned), tuned->warnings);
    add_reports(entry, tuned->report);
    add_as_built(entry, std::move(fitted), control_);
    if (entry.evaluation) {
        entry.longest_sample_time = longest_sample_time_of(*subject_, *entry.evaluation);
        warn_of_region(*entry.evaluation, entry.Ms_limit, result_.model.has_value());
        if (result_.model) warn_of_band(*entry.evaluation, result_.model->excited_band);
        if (problem_ && !planned.of_all && !request_.implement && entry.method == "robust" &&
            entry.options.text("controller") == "PID")
            entry.best_PI_load_IAE = best_PI_load_IAE(*problem_, entry.options, request_.evaluate, control_);
        entry.evaluation->compute_ms = now_ms() - started;
    }
    if (entry.error && entry.error->where.starts_with("controller")) entry.error->where.clear();
    return entry;
}

// The method's entry, and before it one that holds on the record's region, where that is needed and can be had.
std::vector<TuningEntry> TuningRun::entries(const PlannedRow& planned, double from, double to) {
    std::vector<TuningEntry> entries;
    entries.push_back(entry(planned, from, to));
    const bool may = result_.model && request_.identified_region == IdentifiedRegion::where_needed &&
                     planned.method->holds_family && subject_->family() != nullptr;
    const auto& nominal = entries.front().evaluation;
    if (!may || !nominal || result_.partial || stopped() || !breaks_limit(*nominal, entries.front().Ms_limit))
        return entries;
    problem_->family = *subject_->family();
    TuningEntry held = entry(planned, to, to);
    problem_->family = held_;
    if (!held.evaluation || result_.partial) return entries;
    held.over_region = true;
    held.title = with_variant(held.title, "region");
    entries.front().title = with_variant(entries.front().title, "model alone");
    say_choice(*held.evaluation, *nominal);
    entries.insert(entries.begin(), std::move(held));
    return entries;
}

TuningEntry TuningRun::baseline() {
    TuningEntry entry;
    entry.method = "baseline";
    entry.title = "Baseline";
    entry.source = "the settings given in the request";
    const double started = now_ms();
    Controller given = *request_.baseline;
    if (auto* pid = std::get_if<IdealPid>(&given); pid != nullptr && request_.baseline_settings)
        *pid = built::continuous(*pid);
    evaluate_into(entry, given, {});
    add_reports(entry, nullptr);
    add_baseline_as_built(entry);
    if (entry.evaluation && result_.model) warn_of_band(*entry.evaluation, result_.model->excited_band);
    if (entry.evaluation) entry.evaluation->compute_ms = now_ms() - started;
    if (entry.error && entry.error->where.starts_with("controller"))
        entry.error->where.replace(0, std::string("controller").size(), "baseline");
    return entry;
}

void TuningRun::keep_best(const TuningEntry& entry) {
    if (!entry.evaluation) return;
    const auto& [robustness, load] = std::tie(entry.evaluation->robustness, entry.evaluation->performance.load);
    if (!robustness.stable || !load.IAE || !robustness.Ms || *robustness.Ms > request_.evaluate.rank_Ms) return;
    if (best_ && best_->load_IAE <= *load.IAE) return;
    best_ = BestSoFar{entry.evaluation->controller, *load.IAE, *robustness.Ms, robustness.Mt.value_or(0)};
}

// Where a rule has no derivative its PID row is its PI row once more.
bool TuningRun::repeats(const TuningEntry& entry) const {
    const IdealPid* pid = entry.evaluation ? std::get_if<IdealPid>(&entry.evaluation->controller) : nullptr;
    return pid != nullptr && std::ranges::any_of(result_.controllers, [&](const TuningEntry& other) {
               if (other.method != entry.method || !other.evaluation) return false;
               const IdealPid* known = std::get_if<IdealPid>(&other.evaluation->controller);
               return known != nullptr && *known == *pid;
           });
}

// False: stopped before the last row.
bool TuningRun::tune_rows(const std::vector<PlannedRow>& planned, double from, double to) {
    const double share_of_one = (to - from) / static_cast<double>(planned.size());
    for (const PlannedRow& next : planned) {
        if (stopped()) return false;
        report(from, "tune", "Tuning with " + next.title + ".");
        for (TuningEntry& entry : entries(next, from, from + share_of_one)) {
            if (entry.error && entry.error->kind == ErrorKind::cancelled) return false;
            keep_best(entry);
            if (!next.of_all || !repeats(entry)) result_.controllers.push_back(std::move(entry));
        }
        if (result_.partial) return false;
        from += share_of_one;
    }
    return true;
}

// The column "how far from the optimum at the same Ms".
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

// Where several designs are ranked it is by their distance from it.
bool TuningRun::wants_optima() const {
    const bool several = request_.tune.size() > 1 || request_.tune.front().of_all();
    return problem_ && request_.evaluate.optimum_at_Ms.value_or(several);
}

Expected<TuningResult> TuningRun::result() {
    auto planned = plan_rows(request_.tune);
    if (!planned) return planned.error();
    if (const auto error = find_plant()) return *error;
    state_problem();
    if (!problem_ || !problem_->nonlinear)
        std::erase_if(*planned, [](const PlannedRow& row) { return row.of_all && row.method->all_if_nonlinear; });

    const double start = result_.model ? kIdentifyShare : 0;
    const double tuned = wants_optima() ? start + (1 - start) * kRowsShare : 1;
    if (!tune_rows(*planned, start, tuned)) result_.partial = true;
    const bool found =
        std::ranges::any_of(result_.controllers, [](const TuningEntry& e) { return e.evaluation.has_value(); });
    if (!found) return result_.partial ? cancelled() : all_failed(result_.controllers);
    if (request_.baseline) {
        if (stopped())
            result_.partial = true;
        else
            result_.controllers.push_back(baseline());
    }
    if (wants_optima() && !result_.partial) compare_with_optima(tuned);
    draw_together(result_.controllers);
    const RankingTerms terms{request_.evaluate.rank_Ms, subject_->linear() != nullptr};
    result_.ranking = ranked(result_.controllers, terms);
    if (result_.model && !result_.ranking.empty())
        result_.model->region = result_.controllers[static_cast<size_t>(result_.ranking.front())].evaluation->region;
    result_.ranking_by = ranking_by(result_.controllers, terms);
    const verdict::Context context{*subject_, request_.evaluate, request_.labels,
                                   request_.implement ? request_.implement->Ts : 0,
                                   result_.model ? &*result_.model : nullptr};
    verdict::judge(result_.controllers, context);
    result_.verdict = verdict::of_all(result_.controllers, result_.ranking, context, result_.partial);
    report(1, "tune", "Done.");
    return std::move(result_);
}

}  // namespace

Expected<TuningResult> tune(const TuningRequest& request, const RunControl& control) {
    return TuningRun(request, control).result();
}

}  // namespace tunewright
