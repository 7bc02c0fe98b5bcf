#include "api/contract/methods.h"
#include "api/contract/method_options.h"

#include "api/describe/suggest.h"
#include "api/formula/notation.h"
#include "api/service.h"

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

}  // namespace tunewright::api
