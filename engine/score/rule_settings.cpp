#include "engine/score/rule_settings.h"

#include <algorithm>
#include <utility>

#include "engine/tuning/method/rule.h"

namespace tunewright::score {
namespace {

const char* kind_of(CertifiedStructure structure) { return structure == CertifiedStructure::pi ? "PI" : "PID"; }

MethodOptions completed(const TuningMethod& method, MethodOptions options, const Problem& problem) {
    const auto open = [&](const char* name) { return named(method.options, name) != nullptr && !options.has(name); };
    if (open(kControllerOption)) options.set(kControllerOption, std::string(kind_of(problem.structure)));
    if (open("Ms")) options.set("Ms", problem.Ms);
    if (open("Mt")) options.set("Mt", problem.Mt);
    if (problem.Tf > 0 && named(method.options, "filter") != nullptr && options.names("filter").empty())
        options.set("filter/Tf", problem.Tf);
    return options;
}

}  // namespace

bool designs(const TuningMethod& method, const MethodOptions& given, CertifiedStructure structure) {
    if (method.id == "formula") return (structure == CertifiedStructure::pi) == !given.has("Td");
    const OptionDescription* kinds = named(method.options, kControllerOption);
    if (kinds == nullptr) return true;
    if (const auto chosen = given.text(kControllerOption)) return *chosen == kind_of(structure);
    return std::ranges::find(kinds->choices, kind_of(structure)) != kinds->choices.end();
}

SettingsFor settings_by(const TuningMethod& method, const MethodOptions& given, const RunControl& control) {
    return [=](const Problem& problem) -> Expected<IdealPid> {
        auto linear = LinearPlant::make(problem.plant);
        if (!linear) return linear.error();
        const TuningProblem tuning{problem.plant, std::move(*linear), {}};
        RunControl alone;
        alone.stop = control.stop;
        const auto tuned = method.tune(tuning, completed(method, given, problem), alone);
        if (!tuned) return tuned.error();
        if (tuned->nonlinear_integral)
            return Error{ErrorKind::unsupported, "tune/method", "Its integral action is not linear."};
        return tuned->controller;
    };
}

}  // namespace tunewright::score
