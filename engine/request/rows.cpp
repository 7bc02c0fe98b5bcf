#include "engine/request/rows.h"

#include <algorithm>

#include "engine/evaluation/evaluate.h"
#include "engine/evaluation/longest_sample_time.h"
#include "engine/request/identified_region.h"

namespace tunewright {
namespace {

bool in_plant(const Error& error) { return error.where == "plant" || error.where.starts_with("plant/"); }

constexpr const char* kGivenSource = "the settings given in the request";

double now_of(const RunControl& control) { return control.now_ms ? control.now_ms() : 0; }

}  // namespace

Error placed(const TuningRequest& request, Error error, const std::string& where) {
    if (in_plant(error)) {
        if (request.record) error.where = "record";
        if (request.model) error.where = "model";
    } else if (!error.where.empty()) {
        error.where = where + "/" + error.where;
    }
    return error;
}

bool MadeRow::cancelled() const {
    return std::ranges::any_of(
        entries, [](const TuningEntry& entry) { return entry.error && entry.error->kind == ErrorKind::cancelled; });
}

Rows::Rows(const TuningRequest& request, const AnalysedPlant& subject, const std::optional<TuningProblem>& problem,
           const IdentifiedModel* model)
    : request_(request), subject_(subject), problem_(problem), model_(model) {}

Expected<Evaluation> Rows::evaluated(const Controller& controller) {
    const IdealPid* pid = std::get_if<IdealPid>(&controller);
    if (pid == nullptr) return evaluate(subject_, controller, request_.evaluate);
    Evaluated* kept = nullptr;
    {
        const std::lock_guard locked(lock_);
        const auto known = std::ranges::find(evaluated_, *pid, &Evaluated::pid);
        kept = known != evaluated_.end() ? &*known : &evaluated_.emplace_back(*pid);
    }
    std::call_once(kept->once, [&] { kept->evaluation = evaluate(subject_, controller, request_.evaluate); });
    return kept->evaluation;
}

void Rows::evaluate_into(TuningEntry& entry, const Controller& controller, std::vector<Warning> warnings) {
    auto evaluation = evaluated(controller);
    if (!evaluation) {
        entry.error = evaluation.error();
        return;
    }
    warnings.insert(warnings.end(), evaluation->warnings.begin(), evaluation->warnings.end());
    evaluation->warnings = std::move(warnings);
    entry.evaluation = std::move(*evaluation);
}

// Adds the method's own report, completed, and those requested for every controller.
void Rows::add_reports(TuningEntry& entry, std::shared_ptr<MethodReport> own) {
    if (!entry.evaluation || !(own || request_.evaluate.tradeoff)) return;
    const std::lock_guard locked(tradeoffs_lock_);
    if (!tradeoffs_) tradeoffs_.emplace(subject_.nominal(), request_.evaluate);
    if (own) {
        own->complete({subject_, request_.evaluate, *tradeoffs_}, *entry.evaluation);
        entry.reports.push_back(std::move(own));
    }
    if (request_.evaluate.tradeoff && entry.report_as<TradeoffReport>() == nullptr)
        entry.reports.push_back(
            std::make_shared<TradeoffReport>(tradeoffs_->of(entry.evaluation->controller, entry.reduced_model)));
}

// `fitted` receives the settings if the method designs for the implemented controller.
Expected<TunedController> Rows::tuned_with(const PlannedRow& planned, const std::optional<TuningProblem>& problem,
                                           const SetpointOptions& setpoint, const RunControl& control,
                                           std::optional<device::Fitted>& fitted) const {
    const TuningMethod& method = *planned.method;
    const MethodOptions& options = planned.options;
    if (planned.refusal) return *planned.refusal;
    if (problem && request_.device && method.tune_for_device) {
        auto design = method.tune_for_device(*problem, options, *request_.device, control);
        if (!design) return design.error();
        fitted = std::move(design->fitted);
        weigh_setpoint(*fitted, *request_.device, problem->linear, setpoint, design->tuned);
        return std::move(design->tuned);
    }
    if (problem) {
        auto tuned = method.tune(*problem, options, control);
        if (tuned) weigh_setpoint(problem->linear, setpoint, *tuned);
        return tuned;
    }
    if (method.tune_on_points) return method.tune_on_points(*subject_.measured(), options, control);
    return Error{
        ErrorKind::unsupported, "",
        "The method " + method.id +
            " needs a model of the plant; points of a frequency response are enough only for the method robust."};
}

void Rows::add_device_entry(TuningEntry& entry, std::optional<device::Fitted> fitted, const RunControl& control) const {
    if (!request_.device || !entry.evaluation) return;
    const device::DeviceModel& device = *request_.device;
    Evaluation& ideal = *entry.evaluation;
    take_device_entry(fitted ? judge_device(subject_, device, std::move(*fitted), request_.evaluate, ideal)
                             : device_entry_of(subject_, device, request_.evaluate, ideal, control),
                      ideal, entry.on_device);
}

// Adds the figures and findings that today's settings do not have.
void Rows::add_to_design(const RunControl& control, TuningEntry& entry) const {
    entry.longest_sample_time = longest_sample_time_of(subject_, *entry.evaluation, control.stop);
    warn_of_region(*entry.evaluation, region_of(entry), entry.Ms_limit, model_ != nullptr);
}

TuningEntry Rows::entry(const PlannedRow& planned, const std::optional<TuningProblem>& problem,
                        const RunControl& control, bool& partial) {
    TuningEntry entry;
    entry.method = planned.method->id;
    entry.title = planned.title();
    entry.source = planned.method->source;
    const auto& on_points = planned.method->options_on_points;
    entry.options = with_defaults(problem || on_points.empty() ? planned.method->options : on_points, planned.options);
    SetpointOptions setpoint = problem ? wanted_setpoint(*planned.method, entry.options) : SetpointOptions{};
    setpoint.may_filter = !request_.device || request_.device->product == nullptr;
    const double started = now_of(control);
    std::optional<device::Fitted> fitted;
    auto tuned = tuned_with(planned, problem, setpoint, control, fitted);
    if (!tuned) {
        entry.error = placed(request_, tuned.error(), planned.where);
        return entry;
    }
    entry.reduced_model = tuned->reduced_model;
    entry.Ms_limit = tuned->Ms_limit;
    if (planned.Ms_asked) entry.asked_Ms = tuned->Ms_limit;
    entry.asked_overshoot = setpoint_options(planned.options).overshoot;
    partial = partial || tuned->partial;
    evaluate_into(entry, controller_of(*tuned), tuned->warnings);
    add_reports(entry, tuned->report);
    add_device_entry(entry, std::move(fitted), control);
    if (entry.evaluation) {
        add_to_design(control, entry);
        if (model_ != nullptr) warn_of_band(*entry.evaluation, model_->excited_band);
        if (problem && !planned.of_all && !request_.device && entry.method == "robust" &&
            entry.options.text("controller") == "PID")
            entry.best_PI_load_IAE = best_PI_load_IAE(*problem, entry.options, request_.evaluate, control);
        entry.evaluation->compute_ms = now_of(control) - started;
    }
    if (entry.error && entry.error->where.starts_with("controller")) entry.error->where.clear();
    return entry;
}

// The method's entry, and before it one that holds on the record's region if that is needed and possible.
MadeRow Rows::of(const PlannedRow& planned, const RunControl& control) {
    MadeRow made;
    made.entries.push_back(entry(planned, problem_, control, made.partial));
    const bool may = model_ != nullptr && request_.identified_region == IdentifiedRegion::where_needed &&
                     planned.method->holds_family && subject_.family() != nullptr;
    TuningEntry& first = made.entries.front();
    if (!may || !first.evaluation || made.partial || control.stop.stop_requested() ||
        !breaks_limit(region_of(first), first.Ms_limit))
        return made;
    std::optional<TuningProblem> on_region = problem_;
    on_region->family = *subject_.family();
    TuningEntry held = entry(planned, on_region, control, made.partial);
    if (!held.evaluation || made.partial) return made;
    held.over_region = true;
    const Figure &cost = held.evaluation->performance.load.IAE, &alone = first.evaluation->performance.load.IAE;
    if (cost && alone && *alone > 0) held.region_cost = *cost / *alone;
    held.title = planned.title("region");
    first.title = planned.title("model alone");
    say_choice(*held.evaluation, *region_of(first));
    made.entries.insert(made.entries.begin(), std::move(held));
    return made;
}

// `where`: its place in the request.
void Rows::judge_given(const GivenController& given, const std::string& where, bool as_design,
                       const RunControl& control, TuningEntry& entry) {
    const double started = now_of(control);
    evaluate_into(entry, given.law, {});
    add_reports(entry, nullptr);
    if (entry.evaluation) {
        entry.on_device =
            device_entry_of(subject_, given, request_.device, request_.evaluate, *entry.evaluation, control);
        if (as_design) add_to_design(control, entry);
        if (model_ != nullptr) warn_of_band(*entry.evaluation, model_->excited_band);
        entry.evaluation->compute_ms = now_of(control) - started;
    }
    if (entry.error && entry.error->where.starts_with("controller"))
        entry.error->where.replace(0, std::string("controller").size(), where);
}

TuningEntry Rows::given(std::size_t index, const RunControl& control) {
    TuningEntry entry;
    entry.method = kGivenMethod;
    entry.title = "Settings by hand";
    if (request_.controllers.size() > 1) entry.title += " " + std::to_string(index + 1);
    entry.source = kGivenSource;
    judge_given(request_.controllers[index], "controllers/" + std::to_string(index), true, control, entry);
    return entry;
}

TuningEntry Rows::baseline(const RunControl& control) {
    TuningEntry entry;
    entry.method = kBaselineMethod;
    entry.title = "Baseline";
    entry.source = kGivenSource;
    judge_given(*request_.baseline, "baseline", false, control, entry);
    return entry;
}

}  // namespace tunewright
