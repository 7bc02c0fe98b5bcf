// Questions about a loop that are answered without a job: a model, given controllers, the plan of a relay test.
#include "api/contract/relay.h"
#include "api/contract/request.h"
#include "api/mcp/job_tool.h"
#include "api/mcp/message.h"
#include "api/mcp/short_answer.h"
#include "api/mcp/tools.h"

namespace tunewright::api::mcp {
namespace {

using Call = Answer (*)(std::string_view, const RunControl&);

/// Without the model of an earlier answer: an agent gives its plant.
Json evaluate_arguments(ShownTypes& shown) {
    Json schema = tool_schema([](SchemaBook& book) { return evaluate_request_contract().schema(book); }, shown);
    schema["properties"].erase("model");
    return schema;
}

Computation call_of(Call call, const Json& arguments) {
    return [call, body = json_text(arguments)](const RunControl& control) { return call(body, control); };
}

ToolOutcome identify_record(const Json& arguments, ToolHost& host) {
    return computed(call_of(identify_call, arguments), short_model, host);
}

ToolOutcome evaluate_controllers(const Json& arguments, ToolHost& host) {
    Json request = arguments;
    ask_for_no_traces(request);
    return computed(call_of(evaluate_call, request), short_result, host);
}

ToolOutcome plan_relay_test(const Json& arguments, ToolHost& host) {
    return computed(call_of(relay_call, arguments), short_relay, host);
}

}  // namespace

Tool identify_tool() {
    return {.name = "identify",
            .title = "Identify a plant",
            .description =
                "A model of the plant from a recorded test: a step, a relay test, or any record in which the "
                "controller output u moves and the measurement y follows. Gives gain, time constants and dead time "
                "with standard errors, and says whether the test was good enough. Send the record as CSV text "
                "(record.csv, the content of the file and not its path) or as arrays t, u, y. For settings at once, "
                "give the record to tune.",
            .example = R"json({"record": {"csv": "t,u,y\n0,40,20.0\n1,50,20.0\n2,50,20.4\n3,50,21.1\n..."}})json",
            .makes_job = false,
            .arguments =
                [](ShownTypes& shown) {
                    return tool_schema([](SchemaBook& book) { return identify_request_contract().schema(book); },
                                       shown);
                },
            .call = identify_record};
}

Tool evaluate_tool() {
    return {
        .name = "evaluate",
        .title = "Evaluate given controllers",
        .description =
            "Robustness (Ms, Mt, margins), responses and a verdict of the controllers that you give, on a plant. "
            "Use it to judge settings that exist, also as typed into a product ({product, settings}), or to check "
            "a change by hand. Kp in u/y; Ti, Td and dead times in units.time.",
        .example =
            R"json({"plant": "2 e^(-3s)/(10s+1)", "controllers": [{"form": "ideal", "Kp": 0.9, "Ti": 10, "Td": 0}]})json",
        .makes_job = false,
        .arguments = evaluate_arguments,
        .call = evaluate_controllers};
}

Tool plan_relay_test_tool() {
    return {.name = "plan_relay_test",
            .title = "Plan a relay test",
            .description =
                "Simulates a relay experiment on an assumed plant: the steady oscillation (period, amplitude) and a "
                "plan for the real test (levels, hysteresis, cycles, duration, recording interval). Use it before a "
                "person runs the test; it runs nothing itself. Give noise_std, the standard deviation of the "
                "measurement, with relay_sample_time, to get a hysteresis.",
            .example =
                R"json({"plant": "2 e^(-3s)/(10s+1)", "relay": {"u_plus": 1, "u_minus": -1, "noise_std": 0.05, )json"
                R"json("relay_sample_time": 0.1}})json",
            .makes_job = false,
            .arguments =
                [](ShownTypes& shown) {
                    return tool_schema([](SchemaBook& book) { return relay_request_contract().schema(book); }, shown);
                },
            .call = plan_relay_test};
}

}  // namespace tunewright::api::mcp
