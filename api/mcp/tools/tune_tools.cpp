// Settings for a loop: by one method, or by all of them.
#include "api/contract/request.h"
#include "api/contract/terms.h"
#include "api/mcp/job_tool.h"
#include "api/mcp/tools.h"

namespace tunewright::api::mcp {
namespace {

Json tune_arguments(ShownTypes& shown) {
    Json schema = tool_schema([](SchemaBook& book) { return job_contract().schema(book); }, shown);
    leave_out_terms(schema["properties"]);
    return schema;
}

Json compare_arguments(ShownTypes& shown) {
    Json schema = tune_arguments(shown);
    schema["properties"].erase("tune");
    return schema;
}

ToolOutcome tune(const Json& arguments, ToolHost& host) { return run_as_job(arguments, host); }

ToolOutcome compare(const Json& arguments, ToolHost& host) {
    Json request = arguments;
    if (!request.contains("tune")) request["tune"] = "all";
    return run_as_job(std::move(request), host);
}

}  // namespace

Tool tune_tool() {
    return {.name = "tune",
            .title = "Tune a controller",
            .description =
                "Computes PID settings for a plant (typed as text or as an object) or for a recorded test, with "
                "robustness, response and a verdict. The default method `robust` finds the settings with the least "
                "load IAE within Ms and Mt; its option certify proves how much better any other PID could be. "
                "`implement` gives the values to type into a product (ids: list_products), `baseline` compares with "
                "today's settings. Use it instead of guessing gains. An Ms of 1.2 is calm, 2 is sharp.",
            .example = R"json({"plant": "2 e^(-3s)/(10s+1)", "tune": [{"method": "robust", "Ms": 1.6}]})json",
            .makes_job = true,
            .arguments = tune_arguments,
            .call = tune};
}

Tool compare_tool() {
    return {.name = "compare",
            .title = "Compare all tuning methods",
            .description =
                "Settings by every tuning method that applies to the plant or the recorded test, and by today's "
                "settings (`baseline`), ranked by load IAE. Use it to see what a rule such as Ziegler-Nichols costs, "
                "or how far today's settings are from the best. Units as in tune.",
            .example = R"json({"plant": "2 e^(-3s)/(10s+1)", "baseline": {"form": "ideal", "Kp": 0.5, "Ti": 10}})json",
            .makes_job = true,
            .arguments = compare_arguments,
            .call = compare};
}

}  // namespace tunewright::api::mcp
