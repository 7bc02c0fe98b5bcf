#include "api/registries.h"

#include <algorithm>

#include "api/contract/method_options.h"
#include "api/contract/methods.h"
#include "api/contract/product/conversion.h"
#include "api/contract/product/meant_product.h"
#include "api/contract/product/product.h"
#include "api/describe/body.h"
#include "api/describe/suggest.h"
#include "api/formula/method_mathml.h"
#include "api/formula/notation.h"
#include "engine/controller/product/catalogue.h"
#include "engine/controller/product/to_controller.h"
#include "engine/tuning/registry.h"

namespace tunewright::api {
namespace {

Json to_json(const TuningMethod& method) {
    return {{"id", method.id},           {"title", method.title},
            {"formula", method.formula}, {"formula_mathml", method_mathml(method.formula).value()},
            {"needs", method.needs},     {"validity", method.validity},
            {"source", method.source},   {"options", options_schema(method.options)}};
}

}  // namespace

std::string methods_json() {
    static const std::string text = [] {
        Json methods = Json::array();
        for (const TuningMethod& method : method_registry()) methods.push_back(to_json(method));
        return Json{{"methods", std::move(methods)}}.dump();
    }();
    return text;
}

Answer method_json(std::string_view id) {
    if (const TuningMethod* method = find_method(std::string(id))) return {200, to_json(*method).dump()};
    std::vector<std::string> ids;
    for (const TuningMethod& method : method_registry()) ids.push_back(method.id);
    Problem problem{404, "not-found", "There is no such method", "The methods are " + listed(ids, "and") + ".", {}, {}};
    if (const std::string meant = nearest(id, ids); !meant.empty()) problem.detail += " Did you mean " + meant + "?";
    return {404, tunewright::api::to_json(problem)};
}

namespace {

using product::Product;

Answer no_such_controller(std::string_view id) {
    Problem problem{404, "not-found", "There is no such controller", "", {}, {}};
    const std::string meant = meant_product(id);
    problem.detail = meant.empty() ? "GET /v1/controllers, or tunewright controllers, lists them." : meant;
    return refusal(problem);
}

/// The ideal form of a request's controller; for the nonlinear form its linear part, if the nearest settings are asked
/// for.
Expected<IdealPid> ideal_of(const SettingsRequest& request) {
    if (std::holds_alternative<Npid>(*request.controller) && !request.nearest)
        return Error{
            ErrorKind::not_representable, "controller/form",
            "No product of the catalogue has an integral that reduces the effect of large errors. The nearest is the "
            "form ideal with the same Kp, Ti and Td."};
    auto ideal = to_ideal(*request.controller);
    if (!ideal) {
        ideal.error().kind = ErrorKind::not_representable;
        ideal.error().where = "controller";
    }
    return ideal;
}

/// Names that the product does not have, each with a suggestion.
std::optional<Problem> unknown_names(const Product& product, const product::Settings& settings) {
    std::vector<std::string> names;
    for (const product::Parameter& parameter : product.parameters) names.emplace_back(parameter.name);
    if (!product.action.name.empty()) names.emplace_back(product.action.name);
    Reader reader;
    const Reader::At at(reader, "settings");
    for (const product::Setting& setting : settings) {
        if (std::find(names.begin(), names.end(), setting.name) != names.end()) continue;
        const std::string meant = nearest(setting.name, names);
        reader.fault_at(setting.name, setting.name + " is not a parameter here; the parameters are " +
                                          listed(names, "and") + "." +
                                          (meant.empty() ? "" : " Did you mean " + meant + "?"));
    }
    return reader.problem();
}

}  // namespace

std::string controllers_json() {
    static const std::string text = [] {
        Writer out;
        out.begin_object();
        out.key("controllers").begin_array();
        for (const Product& product : product::catalogue()) product_summary_contract().write(product, out);
        out.end_array();
        out.end_object();
        return out.take();
    }();
    return text;
}

Answer controller_json(std::string_view id) {
    const Product* product = product::find(id);
    if (!product) return no_such_controller(id);
    Writer out;
    product_contract().write(*product, out);
    return {200, out.take()};
}

Answer controller_settings_call(std::string_view id, std::string_view body) {
    const Product* product = product::find(id);
    if (!product) return no_such_controller(id);
    const auto decoded = read_body(body, settings_request_contract());
    if (const auto* problem = std::get_if<Problem>(&decoded)) return refusal(*problem);
    const auto& request = std::get<SettingsRequest>(decoded);
    const auto pid = ideal_of(request);
    if (!pid) return refusal(to_problem(pid.error()));
    auto converted = product::to_settings(*product, *pid, request.context, request.nearest);
    if (!converted) return refusal(to_problem(converted.error()));
    Writer out;
    settings_answer_contract().write({product, converted->settings, converted->settings, converted->realised,
                                      std::move(converted->notes), request.context},
                                     out);
    return {200, out.take()};
}

Answer controller_schedule_call(std::string_view id, std::string_view body) {
    const Product* product = product::find(id);
    if (!product) return no_such_controller(id);
    const auto decoded = read_body(body, schedule_settings_request_contract());
    if (const auto* problem = std::get_if<Problem>(&decoded)) return refusal(*problem);
    const auto& request = std::get<ScheduleSettingsRequest>(decoded);
    const Schedule schedule{.interpolation = request.interpolation, .rows = rows_of(request.rows)};
    auto converted = product::to_settings(*product, schedule, request.context, request.nearest);
    if (!converted) return refusal(to_problem(converted.error()));
    Writer out;
    schedule_settings_answer_contract().write({product, *std::move(converted)}, out);
    return {200, out.take()};
}

Answer controller_twin_call(std::string_view id, std::string_view body) {
    const Product* product = product::find(id);
    if (!product) return no_such_controller(id);
    const auto decoded = read_body(body, twin_request_contract());
    if (const auto* problem = std::get_if<Problem>(&decoded)) return refusal(*problem);
    const auto& request = std::get<TwinRequest>(decoded);
    if (const auto problem = unknown_names(*product, request.settings)) return refusal(*problem);
    TwinAnswer answer;
    const auto pid = product::to_controller(*product, request.settings, request.context, answer.notes);
    if (!pid) return refusal(to_problem(pid.error()));
    answer.controller = *pid;
    Writer out;
    twin_answer_contract().write(answer, out);
    return {200, out.take()};
}

}  // namespace tunewright::api
