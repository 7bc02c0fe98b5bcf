#include "engine/tune.h"

#include <algorithm>
#include <numeric>
#include <tuple>

#include "engine/number_text.h"
#include "engine/plant/linear_plant.h"

namespace tunewright {
namespace {

constexpr double kNoticeable = 1.01;    // of a limit, before a warning
constexpr double kIdentifyShare = 0.3;  // of the progress, with a record

Error cancelled() { return {ErrorKind::cancelled, "", "The job was cancelled before a design was found."}; }

// A method's request with its place in the answer's errors ("tune/2", or "" for the parts of "all").
struct Planned {
    const TuningMethod* method;
    MethodOptions options;
    std::string where;
    bool optional_part = false;  // of "all": left out where it does not apply
};

// Of "all", each method takes those options that it knows.
MethodOptions known_options(const MethodOptions& given, const TuningMethod& method) {
    MethodOptions known;
    for (const auto& [path, value] : given.values()) {
        const std::string name = path.substr(0, path.find('/'));
        if (std::ranges::find(method.options, name, &OptionDescription::name) != method.options.end())
            known.set(path, value);
    }
    return known;
}

Error unknown_method(const std::string& id, const std::string& where) {
    std::string known;
    for (const auto& method : method_registry()) known += method.id + ", ";
    return {ErrorKind::invalid_argument, where + "/method",
            "method is \"" + id + "\"; it must be one of " + known + "or all."};
}

Expected<std::vector<Planned>> plan(const std::vector<MethodRequest>& requests) {
    std::vector<Planned> planned;
    for (size_t i = 0; i < requests.size(); ++i) {
        const auto& [id, options] = requests[i];
        const std::string where = "tune/" + std::to_string(i);
        if (id == "all") {
            for (const auto& method : method_registry())
                planned.push_back({&method, known_options(options, method), where, true});
            continue;
        }
        const TuningMethod* method = find_method(id);
        if (!method) return unknown_method(id, where);
        planned.push_back({method, options, where});
    }
    if (planned.empty())
        return Error{ErrorKind::invalid_argument, "tune", "tune is empty; name at least one method, such as robust."};
    return planned;
}

bool in_plant(const Error& error) { return error.where == "plant" || error.where.starts_with("plant/"); }

bool outranks(const Evaluation& a, const Evaluation& b, double rank_Ms) {
    const auto key = [&](const Evaluation& e) {
        const bool within = e.robustness.stable && e.robustness.Ms && *e.robustness.Ms <= rank_Ms;
        const auto& IAE = e.performance.load.IAE;
        return std::tuple(!within, !e.robustness.stable, IAE ? *IAE : std::numeric_limits<double>::infinity());
    };
    return key(a) < key(b);
}

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

// What a method lets itself be asked for as Ms, if it does.
std::optional<double> Ms_limit(const TuningMethod& method, const MethodOptions& options) {
    if (const auto given = options.number("Ms")) return given;
    const auto at = std::ranges::find(method.options, "Ms", &OptionDescription::name);
    if (at == method.options.end() || !at->default_value) return std::nullopt;
    const double* value = std::get_if<double>(&*at->default_value);
    return value ? std::optional(*value) : std::nullopt;
}

void warn_of_region(Evaluation& evaluation, const Planned& planned, bool identified) {
    const auto limit = Ms_limit(*planned.method, planned.options);
    if (!evaluation.region || !evaluation.region->worst_Ms || !limit) return;
    const double worst = *evaluation.region->worst_Ms;
    if (worst <= kNoticeable * *limit) return;
    evaluation.warnings.push_back(
        {"above-limit-in-region", "On the worst plant of the region Ms is " + text(worst) + ", above the " +
                                      text(*limit) + " asked for." +
                                      (identified ? " uncertainty \"identified\" holds the limit on all of it." : "")});
}

void warn_of_band(Evaluation& evaluation, const std::optional<ExcitedBand>& band) {
    const auto& crossover = evaluation.robustness.phase_crossover;
    if (!band || !crossover || *crossover <= band->omega_high) return;
    evaluation.warnings.push_back(
        {"beyond-excited-band",
         "The loop's phase crossover, omega " + text(*crossover) +
             ", lies beyond the band that the record excited (up to omega " + text(band->omega_high) +
             "): there the model is a guess. Ask for less, or repeat the test with faster or larger changes of u."});
}

// The 95 % confidence region of the chosen model.
Expected<PlantFamily> identified_region(const IdentifiedModel& model) {
    auto region = PlantRegion::of_covariance(model.plant, model.covariance.names, model.covariance.matrix);
    if (!region) return region.error();
    return PlantFamily{{std::move(*region)}};
}

// One run of tune(): what its steps share.
class Run {
public:
    Run(const TuningRequest& request, const RunControl& control) : request_(request), control_(control) {}

    Expected<TuningResult> result();

private:
    std::optional<Error> find_plant();
    std::optional<Error> take_plant(const PlantModel& plant);
    std::optional<Error> state_problem();
    Expected<TunedController> tuned_with(const Planned& planned, const RunControl& control) const;
    TuningEntry entry(const Planned& planned, double from, double to);
    TuningEntry baseline() const;
    void evaluate_into(TuningEntry& entry, const Controller& controller, std::vector<Warning> warnings) const;
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
    std::optional<TuningProblem> problem_;   // what methods work on, unless
    std::optional<MeasuredPlant> measured_;  // the plant is known by points alone
    std::optional<BestSoFar> best_;
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

std::optional<Error> Run::take_plant(const PlantModel& plant) {
    if (const auto* points = std::get_if<FrequencyResponse>(&plant)) {
        auto measured = MeasuredPlant::make(*points);
        if (!measured) return measured.error();
        measured_ = std::move(*measured);
        return std::nullopt;
    }
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
    else if (request_.over_identified_region)
        return region.error();
    if (request_.over_identified_region) held_ = family_;
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

void Run::evaluate_into(TuningEntry& entry, const Controller& controller, std::vector<Warning> warnings) const {
    auto evaluation = measured_ ? evaluate(*measured_, controller, request_.evaluate)
                                : evaluate(family_, controller, request_.evaluate);
    if (!evaluation) {
        entry.error = evaluation.error();
        return;
    }
    warnings.insert(warnings.end(), evaluation->warnings.begin(), evaluation->warnings.end());
    evaluation->warnings = std::move(warnings);
    entry.evaluation = std::move(*evaluation);
}

std::optional<Error> Run::state_problem() {
    const Plant& nominal = family_.nominal();
    auto linear = LinearPlant::make(nominal);
    if (!linear) return placed(linear.error(), "");
    problem_ = TuningProblem{nominal, std::move(*linear), dead_time_std_, held_};
    return std::nullopt;
}

Expected<TunedController> Run::tuned_with(const Planned& planned, const RunControl& control) const {
    const TuningMethod& method = *planned.method;
    if (!measured_) return method.tune(*problem_, planned.options, control);
    if (method.tune_on_points) return method.tune_on_points(*measured_, planned.options, control);
    return Error{ErrorKind::unsupported, "",
                 "The method " + method.id +
                     " needs a model of the plant; points of a frequency response serve the method robust."};
}

TuningEntry Run::entry(const Planned& planned, double from, double to) {
    TuningEntry entry;
    entry.method = planned.method->id;
    entry.title = planned.method->title;
    entry.source = planned.method->source;
    entry.options = planned.options;
    const double started = now_ms();
    auto tuned = tuned_with(planned, share(from, to));
    if (!tuned) {
        entry.error = placed(tuned.error(), planned.where);
        return entry;
    }
    entry.reduced_model = tuned->reduced_model;
    entry.surface = tuned->surface;
    if (tuned->rimc) entry.rimc = rimc_entry(*tuned->rimc, problem_->plant, problem_->linear, request_.evaluate);
    result_.partial = result_.partial || tuned->partial;
    evaluate_into(entry, answered(*tuned), tuned->warnings);
    if (entry.evaluation) {
        warn_of_region(*entry.evaluation, planned, result_.model && !held_);
        if (result_.model) warn_of_band(*entry.evaluation, result_.model->excited_band);
        entry.evaluation->compute_ms = now_ms() - started;
    }
    if (entry.error && entry.error->where.starts_with("controller")) entry.error->where.clear();
    return entry;
}

TuningEntry Run::baseline() const {
    TuningEntry entry;
    entry.method = "baseline";
    entry.title = "Baseline";
    entry.source = "the settings given in the request";
    const double started = now_ms();
    evaluate_into(entry, *request_.baseline, {});
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
    best_ =
        BestSoFar{entry.evaluation->controller, *load.IAE, *robustness.Ms, robustness.Mt.value_or(0)};
}

Error all_failed(const std::vector<TuningEntry>& entries) {
    Error error = *entries.front().error;
    const auto same = [&](const TuningEntry& entry) { return entry.error->message == error.message; };
    if (std::ranges::all_of(entries, same)) return error;
    error.message = "No method gave a controller.";
    for (const auto& entry : entries) error.message += " " + entry.method + ": " + entry.error->message;
    return error;
}

Expected<TuningResult> Run::result() {
    const auto planned = plan(request_.tune);
    if (!planned) return planned.error();
    if (const auto error = find_plant()) return *error;
    if (!measured_)
        if (const auto error = state_problem()) return *error;

    const double start = result_.model ? kIdentifyShare : 0,
                 share_of_one = (1 - start) / static_cast<double>(planned->size());
    std::vector<TuningEntry> left_out;
    for (size_t i = 0; i < planned->size() && !result_.partial; ++i) {
        const Planned& next = (*planned)[i];
        if (stopped()) {
            result_.partial = true;
            break;
        }
        const double from = start + share_of_one * static_cast<double>(i);
        report(from, "tune", "Tuning with " + next.method->title + ".");
        TuningEntry entry = this->entry(next, from, from + share_of_one);
        if (entry.error && entry.error->kind == ErrorKind::cancelled) {
            result_.partial = true;
            break;
        }
        keep_best(entry);
        const bool inapplicable = next.optional_part && entry.error && entry.error->kind == ErrorKind::unsupported;
        (inapplicable ? left_out : result_.controllers).push_back(std::move(entry));
    }

    const bool found =
        std::ranges::any_of(result_.controllers, [](const TuningEntry& e) { return e.evaluation.has_value(); });
    if (!found) {
        if (result_.partial) return cancelled();
        result_.controllers.insert(result_.controllers.end(), left_out.begin(), left_out.end());
        return all_failed(result_.controllers);
    }
    if (request_.baseline) {
        if (stopped())
            result_.partial = true;
        else
            result_.controllers.push_back(baseline());
    }
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
