#include "engine/request/ultimate_alone.h"

#include <algorithm>
#include <variant>

#include "engine/number_text.h"
#include "engine/request/plan.h"
#include "engine/request/verdict/verdict.h"

namespace tunewright {
namespace {

constexpr const char* kGain = "Ku";
constexpr const char* kPeriod = "Pu";

bool takes_ultimate(const TuningMethod& method) {
    return std::ranges::any_of(method.options, [](const OptionDescription& option) { return option.name == kGain; });
}

/// A plant of that static gain: the rules on Ku and Pu read nothing else of it.
Expected<TuningProblem> stand_in(double K) {
    const Plant plant = Fopdt{.K = K, .T = 1, .L = 1};
    auto linear = LinearPlant::make(plant);
    if (!linear) return linear.error();
    return TuningProblem{plant, std::move(*linear), {}, {}};
}

Expected<TunedController> tuned_on(const UltimateTest& test, double K, const PlannedRow& row) {
    const auto problem = stand_in(K);
    if (!problem) return problem.error();
    MethodOptions options = row.options;
    options.set(kGain, test.Ku);
    options.set(kPeriod, test.Pu);
    return row.method->tune(*problem, options, {});
}

/// Without the static gain: a rule's settings without its remarks, which are about K Ku.
Expected<TunedController> tuned_without_gain(const UltimateTest& test, const PlannedRow& row) {
    const double one = 2 / test.Ku, other = 7 / test.Ku;
    auto tuned = tuned_on(test, one, row);
    const auto again = tuned_on(test, other, row);
    if (!tuned || !again) return tuned ? again : tuned;
    if (!(tuned->controller == again->controller))
        return Error{ErrorKind::unsupported, "ultimate/K",
                     row.method->id + " also needs the static gain: give K as well as Ku and Pu."};
    tuned->warnings.clear();
    return tuned;
}

Expected<TunedController> tuned(const UltimateTest& test, const PlannedRow& row) {
    if (row.refusal) return *row.refusal;
    if (!takes_ultimate(*row.method))
        return Error{ErrorKind::unsupported, "",
                     "The method " + row.method->id +
                         " needs a model of the plant or a record; Ku and Pu alone are enough only for the rules on "
                         "the ultimate point, such as ziegler_nichols_ultimate."};
    return test.K ? tuned_on(test, *test.K, row) : tuned_without_gain(test, row);
}

TuningEntry entry_of(const UltimateTest& test, const PlannedRow& row) {
    TuningEntry entry;
    entry.method = row.method->id;
    entry.title = row.title();
    entry.source = row.method->source;
    entry.options = with_defaults(row.method->options, row.options);
    auto found = tuned(test, row);
    if (!found) {
        entry.error = found.error();
        if (!entry.error->where.starts_with("ultimate") && !entry.error->where.empty())
            entry.error->where = row.where + "/" + entry.error->where;
        entry.verdict = verdict::no_controller(*entry.error);
        return entry;
    }
    entry.unjudged = controller_of(*found);
    entry.verdict = verdict::without_loop(*entry.unjudged, test.Ku, found->warnings);
    return entry;
}

}  // namespace

std::optional<Error> UltimateTest::fault() const {
    if (!K || Ku * *K > 0) return std::nullopt;
    return Error{ErrorKind::invalid_argument, "ultimate/Ku",
                 "Ku is " + text(Ku) + " and K is " + text(*K) +
                     "; they must have the same sign. Give both with the signs that were measured, or leave K out."};
}

Expected<TuningResult> tune_on_ultimate(const TuningRequest& request) {
    if (auto fault = request.ultimate->fault()) return *fault;
    auto planned = plan_rows(request.tune);
    if (!planned) return planned.error();
    std::erase_if(*planned, [](const PlannedRow& row) { return row.of_all && !takes_ultimate(*row.method); });
    TuningResult result;
    for (const PlannedRow& row : *planned) {
        TuningEntry entry = entry_of(*request.ultimate, row);
        if (entry.unjudged) result.ranking.push_back(static_cast<int>(result.controllers.size()));
        result.controllers.push_back(std::move(entry));
    }
    if (result.ranking.empty()) return all_failed(result.controllers);
    result.ranking_by = "the order of the methods; they are not ranked, because no plant is known";
    result.verdict = verdict::of_all_without_loop();
    result.proposed = verdict::proposed(result.controllers, result.verdict);
    return result;
}

}  // namespace tunewright
