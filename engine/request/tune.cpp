#include "engine/request/tune.h"

#include <algorithm>
#include <numeric>
#include <tuple>

#include "engine/number_text.h"
#include "engine/plant/linear/linear_plant.h"
#include "engine/plant/nonlinear/linearised_plant.h"
#include "engine/request/identified_region.h"
#include "engine/request/league.h"

namespace tunewright {
namespace {

constexpr double kIdentifyShare = 0.3;  // of the progress, with a record
constexpr double kRowsShare = 0.3;      // of what then remains, where optima are computed for every row

Error cancelled() { return {ErrorKind::cancelled, "", "The job was cancelled before a design was found."}; }

bool in_plant(const Error& error) { return error.where == "plant" || error.where.starts_with("plant/"); }

std::vector<int> ranking(const std::vector<TuningEntry>& entries, double rank_Ms) {
    std::vector<int> order;
    for (size_t i = 0; i < entries.size(); ++i)
        if (entries[i].evaluation) order.push_back(static_cast<int>(i));
    std::ranges::stable_sort(order, [&](int a, int b) {
        return outranks(*entries[static_cast<size_t>(a)].evaluation, *entries[static_cast<size_t>(b)].evaluation,
                        rank_Ms);
    });
    return order;
}

// One run of tune(): what its steps share.
class Run {
public:
    Run(const TuningRequest& request, const RunControl& control) : request_(request), control_(control) {}

    Expected<TuningResult> result();

private:
    std::optional<Error> find_plant();
    std::optional<Error> take_plant(const PlantModel& plant);
    std::optional<Error> take_equations(const NonlinearPlant& plant);
    std::optional<Error> state_problem();
    Expected<TunedController> tuned_with(const PlannedRow& planned, const RunControl& control) const;
    TuningEntry entry(const PlannedRow& planned, double from, double to);
    std::vector<TuningEntry> entries(const PlannedRow& planned, double from, double to);
    bool repeats(const TuningEntry& entry) const;
    bool tune_rows(const std::vector<PlannedRow>& planned, double from, double to);
    bool wants_optima() const;
    void compare_with_optima(double from);
    TuningEntry baseline();
    Expected<Evaluation> evaluated(const Controller& controller);
    void evaluate_into(TuningEntry& entry, const Controller& controller, std::vector<Warning> warnings);
    void add_tradeoff(TuningEntry& entry, const std::optional<ArrietaReport>& rule);
    Error placed(Error error, const std::string& where) const;
    void keep_best(const TuningEntry& entry);
    RunControl share(double from, double to) const;
    void report(double fraction, const std::string& stage, const std::string& message) const;
    double now_ms() const { return control_.now_ms ? control_.now_ms() : 0; }
    bool stopped() const { return control_.stop.stop_requested(); }

    const TuningRequest& request_;
    const RunControl& control_;
    PlantFamily family_;               // what every controller is judged on
    std::optional<PlantFamily> held_;  // where limits must hold, if that is more than one plant
    std::optional<double> dead_time_std_;
    std::optional<TuningProblem> problem_;      // what methods work on, unless
    std::optional<MeasuredPlant> measured_;     // the plant is known by points alone
    std::optional<NonlinearSystem> nonlinear_;  // what family_ is the linearisation of, if it is one
    std::optional<BestSoFar> best_;
    std::optional<Tradeoffs> tradeoffs_;  // made when first asked for
    std::vector<std::pair<Pid, Evaluation>> evaluated_;
    TuningResult result_;
};

void Run::report(double fraction, const std::string& stage, const std::string& message) const {
    if (control_.progress) control_.progress({fraction, stage, message, best_});
}

// A part of the work sees 0 to 1 as its own; the better of its best design and ours is reported.
RunControl Run::share(double from, double to) const {
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

std::optional<Error> Run::take_equations(const NonlinearPlant& plant) {
    auto system = NonlinearSystem::make(plant);
    if (!system) return system.error();
    result_.operating_point = operating_point(*system);
    family_ = family_of(Plant(system->linearised()));
    nonlinear_ = std::move(*system);
    return std::nullopt;
}

std::optional<Error> Run::take_plant(const PlantModel& plant) {
    if (const auto* points = std::get_if<FrequencyResponse>(&plant)) {
        auto measured = MeasuredPlant::make(*points);
        if (!measured) return measured.error();
        measured_ = std::move(*measured);
        return std::nullopt;
    }
    if (const auto* equations = std::get_if<NonlinearPlant>(&plant)) return take_equations(*equations);
    const auto* set = std::get_if<PlantSet>(&plant);
    family_ = set ? family_of(*set) : family_of(std::get<Plant>(plant));
    if (!family_.single()) held_ = family_;
    return std::nullopt;
}

std::optional<Error> Run::find_plant() {
    if (request_.plant.has_value() == request_.record.has_value())
        return Error{ErrorKind::invalid_argument, "",
                     request_.plant ? "Both plant and record are given; give one of them."
                                    : "Neither plant nor record is given; give one of them."};
    if (request_.plant) {
        return take_plant(*request_.plant);
    }
    report(0, "identify", "Fitting models to the record.");
    auto model = identify(*request_.record, request_.identify, share(0, kIdentifyShare));
    if (!model) return model.error();
    family_ = family_of(model->plant);
    if (auto region = identified_region(*model))
        family_ = *region;
    else if (request_.identified_region == IdentifiedRegion::held)
        return region.error();
    if (request_.identified_region == IdentifiedRegion::held) held_ = family_;
    if (const auto at = model->standard_errors.find("L"); at != model->standard_errors.end())
        dead_time_std_ = at->second;
    result_.model = std::move(*model);
    return std::nullopt;
}

// Methods name an option or a field of the plant; the request has the one under the method's place, and the other only
// if it gave a plant.
Error Run::placed(Error error, const std::string& where) const {
    if (in_plant(error)) {
        if (request_.record) error.where = "record";
    } else if (!error.where.empty()) {
        error.where = where + "/" + error.where;
    }
    return error;
}

// Several rules may give the very same controller: it is evaluated once.
Expected<Evaluation> Run::evaluated(const Controller& controller) {
    const Pid* pid = std::get_if<Pid>(&controller);
    if (pid != nullptr)
        for (const auto& [known, evaluation] : evaluated_)
            if (known == *pid) return evaluation;
    auto evaluation = measured_    ? evaluate(*measured_, controller, request_.evaluate)
                      : nonlinear_ ? evaluate(*nonlinear_, controller, request_.evaluate)
                                   : evaluate(family_, controller, request_.evaluate);
    if (evaluation && pid != nullptr) evaluated_.emplace_back(*pid, *evaluation);
    return evaluation;
}

void Run::evaluate_into(TuningEntry& entry, const Controller& controller, std::vector<Warning> warnings) {
    auto evaluation = evaluated(controller);
    if (!evaluation) {
        entry.error = evaluation.error();
        return;
    }
    warnings.insert(warnings.end(), evaluation->warnings.begin(), evaluation->warnings.end());
    evaluation->warnings = std::move(warnings);
    entry.evaluation = std::move(*evaluation);
}

// Of a servo/regulation rule always, of other controllers where asked for.
void Run::add_tradeoff(TuningEntry& entry, const std::optional<ArrietaReport>& rule) {
    if (!entry.evaluation || !(rule || request_.evaluate.tradeoff)) return;
    if (!tradeoffs_) tradeoffs_.emplace(measured_ ? std::nullopt : std::optional(family_.nominal()), request_.evaluate);
    const Controller& controller = entry.evaluation->controller;
    if (!rule) {
        entry.tradeoff = tradeoffs_->of(controller, entry.reduced_model);
        return;
    }
    entry.tradeoff = tradeoffs_->of_rule(controller, *rule);
    if (const auto warning = missed_degradation(*rule, *entry.tradeoff)) entry.evaluation->warnings.push_back(*warning);
}

std::optional<Error> Run::state_problem() {
    const Plant& nominal = family_.nominal();
    auto linear = nonlinear_ ? linearised_plant(*nonlinear_) : LinearPlant::make(nominal);
    if (!linear) return placed(linear.error(), "");
    problem_ = TuningProblem{nominal, std::move(*linear), dead_time_std_, held_};
    if (nonlinear_) problem_->nonlinear = &*nonlinear_;
    if (result_.model && result_.model->limit_cycle)
        problem_->relay_point = result_.model->limit_cycle->describing_function;
    return std::nullopt;
}

Expected<TunedController> Run::tuned_with(const PlannedRow& planned, const RunControl& control) const {
    const TuningMethod& method = *planned.method;
    const MethodOptions& options = planned.options;
    if (planned.refusal) return *planned.refusal;
    if (!measured_) return method.tune(*problem_, options, control);
    if (method.tune_on_points) return method.tune_on_points(*measured_, options, control);
    return Error{ErrorKind::unsupported, "",
                 "The method " + method.id +
                     " needs a model of the plant; points of a frequency response serve the method robust."};
}

TuningEntry Run::entry(const PlannedRow& planned, double from, double to) {
    TuningEntry entry;
    entry.method = planned.method->id;
    entry.title = planned.title;
    entry.source = planned.method->source;
    const auto& on_points = planned.method->options_on_points;
    entry.options =
        with_defaults(measured_ && !on_points.empty() ? on_points : planned.method->options, planned.options);
    const double started = now_ms();
    auto tuned = tuned_with(planned, share(from, to));
    if (!tuned) {
        entry.error = placed(tuned.error(), planned.where);
        return entry;
    }
    entry.reduced_model = tuned->reduced_model;
    entry.surface = tuned->surface;
    entry.emulation = std::move(tuned->emulation);
    if (entry.emulation && request_.evaluate.points == 0) entry.emulation->drop_traces();
    if (tuned->rimc) entry.rimc = rimc_entry(*tuned->rimc, problem_->plant, problem_->linear, request_.evaluate);
    result_.partial = result_.partial || tuned->partial;
    evaluate_into(entry, controller_of(*tuned), tuned->warnings);
    add_tradeoff(entry, tuned->arrieta);
    if (entry.evaluation) {
        warn_of_region(*entry.evaluation, planned, result_.model.has_value());
        if (result_.model) warn_of_band(*entry.evaluation, result_.model->excited_band);
        entry.evaluation->compute_ms = now_ms() - started;
    }
    if (entry.error && entry.error->where.starts_with("controller")) entry.error->where.clear();
    return entry;
}

// The method's entry, and before it one that holds on the record's region, where that is needed and can be had.
std::vector<TuningEntry> Run::entries(const PlannedRow& planned, double from, double to) {
    std::vector<TuningEntry> entries;
    entries.push_back(entry(planned, from, to));
    const bool may = result_.model && request_.identified_region == IdentifiedRegion::where_needed &&
                     planned.method->holds_family && !family_.single();
    const auto& nominal = entries.front().evaluation;
    if (!may || !nominal || result_.partial || stopped() || !breaks_limit(*nominal, planned)) return entries;
    problem_->family = family_;
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

TuningEntry Run::baseline() {
    TuningEntry entry;
    entry.method = "baseline";
    entry.title = "Baseline";
    entry.source = "the settings given in the request";
    const double started = now_ms();
    evaluate_into(entry, *request_.baseline, {});
    add_tradeoff(entry, std::nullopt);
    if (entry.evaluation && result_.model) warn_of_band(*entry.evaluation, result_.model->excited_band);
    if (entry.evaluation) entry.evaluation->compute_ms = now_ms() - started;
    if (entry.error && entry.error->where.starts_with("controller"))
        entry.error->where.replace(0, std::string("controller").size(), "baseline");
    return entry;
}

void Run::keep_best(const TuningEntry& entry) {
    if (!entry.evaluation) return;
    const auto& [robustness, load] = std::tie(entry.evaluation->robustness, entry.evaluation->performance.load);
    if (!robustness.stable || !load.IAE || !robustness.Ms || *robustness.Ms > request_.evaluate.rank_Ms) return;
    if (best_ && best_->load_IAE <= *load.IAE) return;
    best_ = BestSoFar{entry.evaluation->controller, *load.IAE, *robustness.Ms, robustness.Mt.value_or(0)};
}

// Reasons that several methods share are told once.
Error all_failed(const std::vector<TuningEntry>& entries) {
    std::vector<std::pair<std::string, std::string>> told;  // methods, reason
    for (const auto& entry : entries) {
        const auto at = std::ranges::find(told, entry.error->message, &std::pair<std::string, std::string>::second);
        if (at == told.end())
            told.emplace_back(entry.method, entry.error->message);
        else if (!(", " + at->first).ends_with(", " + entry.method))
            at->first += ", " + entry.method;
    }
    Error error = *entries.front().error;
    if (told.size() == 1) return error;
    error.message = "No method gave a controller.";
    for (const auto& [methods, reason] : told) error.message += " " + methods + ": " + reason;
    return error;
}

// Where a rule has no derivative its PID row is its PI row once more.
bool Run::repeats(const TuningEntry& entry) const {
    const Pid* pid = entry.evaluation ? std::get_if<Pid>(&entry.evaluation->controller) : nullptr;
    return pid != nullptr && std::ranges::any_of(result_.controllers, [&](const TuningEntry& other) {
               if (other.method != entry.method || !other.evaluation) return false;
               const Pid* known = std::get_if<Pid>(&other.evaluation->controller);
               return known != nullptr && *known == *pid;
           });
}

// False: stopped before the last row.
bool Run::tune_rows(const std::vector<PlannedRow>& planned, double from, double to) {
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
void Run::compare_with_optima(double from) {
    RobustOptima optima(*problem_, nonlinear_ ? on_linearisation(*nonlinear_, request_.evaluate) : request_.evaluate);
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

bool Run::wants_optima() const {
    const bool league = std::ranges::any_of(request_.tune, [](const MethodRequest& r) { return r.of_all(); });
    return !measured_ && request_.evaluate.optimum_at_Ms.value_or(league);
}

Expected<TuningResult> Run::result() {
    auto planned = plan_rows(request_.tune);
    if (!planned) return planned.error();
    if (const auto error = find_plant()) return *error;
    if (!measured_)
        if (const auto error = state_problem()) return *error;
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
    result_.ranking = ranking(result_.controllers, request_.evaluate.rank_Ms);
    if (result_.model && !result_.ranking.empty())
        result_.model->region = result_.controllers[static_cast<size_t>(result_.ranking.front())].evaluation->region;
    result_.ranking_by =
        "load IAE among stable entries with Ms <= " + text(request_.evaluate.rank_Ms) + ", then the rest";
    report(1, "tune", "Done.");
    return std::move(result_);
}

}  // namespace

Expected<TuningResult> tune(const TuningRequest& request, const RunControl& control) {
    return Run(request, control).result();
}

}  // namespace tunewright
