#include "engine/score/score.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/evaluation/evaluate.h"
#include "engine/reduction/reduction.h"
#include "engine/tuning/limits.h"
#include "engine/tuning/method/rule.h"

namespace tunewright::score {
namespace {

Filter filter_of(const Problem& problem, double Td) {
    const bool tied = problem.structure == CertifiedStructure::pid_tied;
    const double Tf = tied ? limits::kDefaultTf_over_Td * Td : problem.Tf;
    return Tf > 0 ? Filter{FilterType::measurement_second_order, Tf} : Filter{};
}

double tau_of(const Plant& plant) {
    const auto linear = LinearPlant::make(plant);
    if (!linear) return 0;
    const auto model = reduce(*linear, {.preferred = ReductionMethod::tangent});
    return model ? normalised_dead_time(*model) : 0;
}

bool holds(double value, double limit) { return value <= limit * (1 + limits::kMaxRelativeExcessJudged); }

void judge(const Problem& problem, const Evaluation& evaluation, ProblemScore& out) {
    if (!evaluation.robustness.stable) {
        out.status = Status::unstable;
        return;
    }
    const Figure& IAE = evaluation.performance.load.IAE;
    out.Ms = *evaluation.robustness.Ms;
    out.Mt = *evaluation.robustness.Mt;
    if (!IAE) {
        out.why = IAE.why.empty() ? "The IAE has no value." : IAE.why;
        return;
    }
    out.IAE = *IAE;
    out.ratio = *IAE / problem.lower;
    out.status = holds(out.Ms, problem.Ms) && holds(out.Mt, problem.Mt) ? Status::kept : Status::limits_broken;
}

Expected<ProblemScore> score_of(const Problem& problem, const SettingsFor& settings) {
    ProblemScore out{.name = problem.name, .tau = tau_of(problem.plant), .controller = {}, .why = {}};
    auto pid = settings(problem);
    // An argument that is wrong by itself is the request's fault, not the problem's.
    if (!pid && pid.error().kind == ErrorKind::invalid_argument) return pid.error();
    if (!pid) {
        out.why = pid.error().message;
        return out;
    }
    if (problem.structure == CertifiedStructure::pi && pid->Td > 0) {
        out.why = "The settings have a derivative, and the problem asks for a PI controller.";
        return out;
    }
    pid->filter = filter_of(problem, pid->Td);
    pid->b = 1;
    out.controller = *pid;
    EvaluateOptions options;
    options.points = 0;
    const auto evaluation = evaluate(PlantModel(problem.plant), *pid, options);
    if (evaluation)
        judge(problem, *evaluation, out);
    else
        out.why = evaluation.error().message;
    return out;
}

bool is_kept(const ProblemScore& one) { return one.status == Status::kept; }

void count(Score& score) {
    for (const ProblemScore& one : score.problems) switch (one.status) {
            case Status::kept: ++score.kept; break;
            case Status::limits_broken: ++score.limits_broken; break;
            case Status::unstable: ++score.unstable; break;
            case Status::no_settings: ++score.no_settings; break;
        }
}

void add_profile(Score& score) {
    std::vector<double> ratios;
    for (const ProblemScore& one : score.problems)
        if (is_kept(one)) ratios.push_back(one.ratio);
    if (ratios.empty()) return;
    std::ranges::sort(ratios);
    score.median_ratio = 0.5 * (ratios[(ratios.size() - 1) / 2] + ratios[ratios.size() / 2]);
    score.worst_ratio = ratios.back();
    for (std::size_t i = 0; i < ratios.size(); ++i)
        if (i + 1 == ratios.size() || ratios[i + 1] > ratios[i])
            score.profile.push_back({ratios[i], double(i + 1) / double(score.problems.size())});
}

void add_range(Score& score) {
    std::vector<const ProblemScore*> by_tau;
    for (const ProblemScore& one : score.problems) by_tau.push_back(&one);
    std::ranges::stable_sort(by_tau, {}, &ProblemScore::tau);
    Range run;
    for (std::size_t i = 0; i < by_tau.size();) {
        // Problems of equal tau stand together: none of them lies within a range that leaves another one out.
        std::size_t next = i;
        bool all_kept = true;
        double worst = 0;
        for (; next < by_tau.size() && by_tau[next]->tau == by_tau[i]->tau; ++next) {
            all_kept = all_kept && is_kept(*by_tau[next]);
            worst = std::max(worst, by_tau[next]->ratio);
        }
        if (!all_kept) {
            run = {};
        } else {
            if (run.problems == 0) run.tau_low = by_tau[i]->tau;
            run.tau_high = by_tau[i]->tau;
            run.problems += int(next - i);
            run.worst_ratio = std::max(run.worst_ratio, worst);
            if (!score.range || run.problems > score.range->problems) score.range = run;
        }
        i = next;
    }
}

}  // namespace

const char* to_string(Status status) {
    switch (status) {
        case Status::kept: return "kept";
        case Status::limits_broken: return "limits-broken";
        case Status::unstable: return "unstable";
        case Status::no_settings: return "no-settings";
    }
    return "no-settings";
}

Expected<Score> score(const std::vector<Problem>& problems, const SettingsFor& settings, const RunControl& control) {
    std::vector<Expected<ProblemScore>> scores(problems.size(), ProblemScore{});
    parallel_for(control.spread, int(problems.size()), [&](int i) {
        if (!control.stop.stop_requested()) scores[std::size_t(i)] = score_of(problems[std::size_t(i)], settings);
    });
    if (control.stop.stop_requested()) return Error{ErrorKind::cancelled, "", "The scoring was stopped."};
    Score out;
    for (auto& one : scores) {
        if (!one) return one.error();
        out.problems.push_back(std::move(*one));
    }
    count(out);
    add_profile(out);
    add_range(out);
    return out;
}

}  // namespace tunewright::score
