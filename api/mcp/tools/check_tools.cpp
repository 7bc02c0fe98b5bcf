// Faults of loops in operation.
#include "api/contract/check/check_request.h"
#include "api/contract/terms.h"
#include "api/describe/body.h"
#include "api/mcp/job_tool.h"
#include "api/mcp/tools.h"

namespace tunewright::api::mcp {
namespace {

Json check_arguments(ShownTypes& shown) {
    Json schema = tool_schema([](SchemaBook& book) { return check_request_contract().schema(book); }, shown);
    leave_out_terms(schema["properties"]);
    return schema;
}

/// Without loops the request would be one about a plant.
ToolOutcome check_record(const Json& arguments, ToolHost& host) {
    if (arguments.contains("loops")) return run_as_job(arguments, host);
    const auto read = decode(arguments, check_request_contract());
    return refused(std::get<Problem>(read));
}

}  // namespace

Tool check_record_tool() {
    return {
        .name = "check_record",
        .title = "Check a loop in operation",
        .description =
            "Why a loop in operation works badly: from a record of normal operation (hours to days, no test "
            "needed) with measurement, output, set point and mode it tells a sticking valve, a disturbance from "
            "another loop, saturation, bad tuning or a healthy loop apart, with evidence and what to do first. "
            "Use it before tuning a loop that oscillates. One or several loops.",
        .example =
            R"json({"loops": [{"tag": "FIC101", "kind": "flow", "csv": "t,sp,pv,op,mode\n0,50,49.8,31.2,AUTO\n1,..."}]})json",
        .makes_job = true,
        .arguments = check_arguments,
        .call = check_record};
}

}  // namespace tunewright::api::mcp
