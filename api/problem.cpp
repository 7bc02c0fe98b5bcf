#include "api/problem.h"

#include "api/json/parse.h"
#include "api/json/writer.h"

namespace tunewright::api {
namespace {

struct Row {
    ErrorKind kind;
    int status;
    const char* title;
};

constexpr Row kTable[] = {
    {ErrorKind::invalid_argument, 422, "The request is not valid"},
    {ErrorKind::unsupported, 422, "This cannot be done for this plant or method"},
    {ErrorKind::not_identifiable, 422, "The record does not determine a model"},
    {ErrorKind::unstable_plant, 422, "No controller of this kind stabilises the plant"},
    {ErrorKind::no_feasible_controller, 422, "No controller keeps the limits"},
    {ErrorKind::unbounded_optimum, 422, "The optimum runs away"},
    {ErrorKind::cancelled, 409, "The job was cancelled"},
    {ErrorKind::timeout, 504, "The time allowed is over"},
    {ErrorKind::numerical_failure, 500, "The computation did not reach its accuracy"},
};

// "plant/A/0" -> "/plant/A/0"
std::string to_pointer(const std::string& where) {
    std::string pointer;
    std::size_t start = 0;
    while (start <= where.size()) {
        const std::size_t end = std::min(where.find('/', start), where.size());
        if (end > start) pointer += "/" + pointer_segment(where.substr(start, end - start));
        start = end + 1;
    }
    return pointer;
}

}  // namespace

Problem to_problem(const Error& error) {
    Problem problem;
    problem.type = to_string(error.kind);
    problem.detail = error.message;
    for (const Row& row : kTable) {
        if (row.kind != error.kind) continue;
        problem.status = row.status;
        problem.title = row.title;
    }
    if (error.kind == ErrorKind::invalid_argument) problem.type = "invalid-request";
    if (!error.where.empty()) problem.errors.push_back({to_pointer(error.where), error.message});
    return problem;
}

std::string to_json(const Problem& problem) {
    Writer out;
    out.begin_object();
    out.key("type");
    out.text(problem.type);
    out.key("title");
    out.text(problem.title);
    out.key("status");
    out.integer(problem.status);
    out.key("detail");
    out.text(problem.detail);
    if (!problem.instance.empty()) {
        out.key("instance");
        out.text(problem.instance);
    }
    if (!problem.errors.empty()) {
        out.key("errors");
        out.begin_array();
        for (const FieldError& error : problem.errors) {
            out.begin_object();
            out.key("pointer");
            out.text(error.pointer);
            out.key("detail");
            out.text(error.detail);
            out.end_object();
        }
        out.end_array();
    }
    out.end_object();
    return out.take();
}

}  // namespace tunewright::api
