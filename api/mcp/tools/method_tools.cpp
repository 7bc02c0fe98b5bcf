// The tuning methods.
#include "api/describe/body.h"
#include "api/mcp/tools.h"
#include "api/mcp/tools/arguments.h"
#include "api/registries.h"
#include "api/report/terminal/terminal.h"

namespace tunewright::api::mcp {
namespace {

ToolOutcome list_methods(const Json& arguments, ToolHost&) {
    const auto read = decode(arguments, method_question_contract());
    if (const auto* problem = std::get_if<Problem>(&read)) return refused(*problem);
    const auto& question = std::get<MethodQuestion>(read);
    if (!question.method) return ToolAnswer{methods_text(methods_json()), nullptr};
    const Answer one = method_json(*question.method);
    if (one.status >= 400) return Refused{one.body};
    return ToolAnswer{without_members(one.body, {"formula_mathml", "x-slider", "x-main"}), nullptr};
}

}  // namespace

Tool list_methods_tool() {
    return {.name = "list_methods",
            .title = "List tuning methods",
            .description =
                "Ids and titles of the tuning methods for tune's tune[].method; or one method in full, "
                "with formula, validity, source and options.",
            .example = R"json({"method": "simc"})json",
            .makes_job = false,
            .arguments =
                [](ShownTypes& shown) {
                    return tool_schema([](SchemaBook& book) { return method_question_contract().schema(book); }, shown);
                },
            .call = list_methods};
}

}  // namespace tunewright::api::mcp
