#include "api/mcp/tools.h"

#include <algorithm>

#include "api/describe/reader.h"
#include "api/describe/suggest.h"
#include "api/mcp/message.h"
#include "api/mcp/refusal.h"

namespace tunewright::api::mcp {
namespace {

/// Effects of the tool on its surroundings. None writes to a plant or changes what exists; a job is one more in the
/// store.
Json annotations(const Tool& tool, const ToolHost& host) {
    const bool stores = tool.makes_job && host.stores_jobs();
    return {{"title", tool.title},
            {"readOnlyHint", !stores},
            {"destructiveHint", false},
            {"idempotentHint", !stores},
            {"openWorldHint", false}};
}

/// The schemas of all arguments, in the order of the tools.
const std::vector<Json>& argument_schemas() {
    static const std::vector<Json> all = [] {
        ShownTypes shown;
        std::vector<Json> made;
        for (const Tool& tool : tools()) made.push_back(tool.arguments(shown));
        return made;
    }();
    return all;
}

Json content(std::string text) { return Json::array({{{"type", "text"}, {"text", std::move(text)}}}); }

}  // namespace

const std::vector<Tool>& tools() {
    static const std::vector<Tool> all{tune_tool(),     identify_tool(),      check_record_tool(),
                                       compare_tool(),  evaluate_tool(),      plan_relay_test_tool(),
                                       settings_tool(), list_products_tool(), list_methods_tool(),
                                       code_tool(),     test_program_tool(),  job_status_tool()};
    return all;
}

const Tool* find_tool(std::string_view name) {
    const auto found = std::ranges::find_if(tools(), [&](const Tool& tool) { return name == tool.name; });
    return found == tools().end() ? nullptr : &*found;
}

std::string no_such_tool(const std::string& name) {
    std::vector<std::string> names;
    for (const Tool& tool : tools()) names.emplace_back(tool.name);
    const std::string meant = nearest(name, names);
    return "There is no tool " + shown(name) + "." + (meant.empty() ? "" : " Did you mean " + meant + "?") +
           " The tools are " + listed(names, "and") + ".";
}

std::string tool_list(const ToolHost& host) {
    Json list = Json::array();
    for (std::size_t i = 0; i < tools().size(); ++i) {
        const Tool& tool = tools()[i];
        list.push_back({{"name", tool.name},
                        {"title", tool.title},
                        {"description", tool.description},
                        {"inputSchema", argument_schemas()[i]},
                        {"annotations", annotations(tool, host)}});
    }
    return json_text({{"tools", std::move(list)}});
}

std::string call_tool(const Tool& tool, const Json& arguments, ToolHost& host) {
    ToolOutcome outcome = arguments.is_null()     ? tool.call(Json::object(), host)
                          : arguments.is_object() ? tool.call(arguments, host)
                                                  : not_an_object(arguments);
    if (const auto* refused = std::get_if<Refused>(&outcome)) {
        const Json problem = shown_problem(refused->problem);
        return json_text({{"content", content(refusal_text(problem, tool))},
                          {"structuredContent", {{"error", problem}}},
                          {"isError", true}});
    }
    auto& answer = std::get<ToolAnswer>(outcome);
    Json result{{"content", content(std::move(answer.text))}};
    if (!answer.figures.is_null()) result["structuredContent"] = std::move(answer.figures);
    return json_text(result);
}

}  // namespace tunewright::api::mcp
