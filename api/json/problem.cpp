#include "api/json/problem.h"

#include <algorithm>
#include <cmath>

#include "api/json/json.h"
#include "api/json/writer.h"
#include "engine/identification/record/record_kind.h"
#include "engine/number_text.h"

namespace tunewright::api {
namespace {

struct KindRow {
    ErrorKind kind;
    int status;
    const char* title;
};

constexpr KindRow kTable[] = {
    {ErrorKind::invalid_argument, 422, "The request is not valid"},
    {ErrorKind::unsupported, 422, "This is not possible for this plant or method"},
    {ErrorKind::not_identifiable, 422, "The record does not determine a model"},
    {ErrorKind::unstable_plant, 422, "No controller of this kind stabilises the plant"},
    {ErrorKind::no_feasible_controller, 422, "No controller keeps the limits"},
    {ErrorKind::unbounded_optimum, 422, "The optimum is unbounded"},
    {ErrorKind::not_representable, 422, "The product cannot represent this controller"},
    {ErrorKind::cancelled, 409, "The job was cancelled"},
    {ErrorKind::timeout, 504, "The time limit is over"},
    {ErrorKind::numerical_failure, 422, "The computation did not reach its accuracy"},
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

/// The text of a cure, "Use Ms = Mt = 1.603": options with the same value are named together.
Cure cure_of(const std::map<std::string, double>& options) {
    Cure cure{"Use", {options.begin(), options.end()}};
    for (std::size_t i = 0; i < cure.options.size(); ++i) {
        const auto& [name, value] = cure.options[i];
        const bool same = i + 1 < cure.options.size() && cure.options[i + 1].second == value;
        cure.text += " " + name + " =" + (same ? "" : " " + tunewright::text(value));
        if (!same && i + 1 < cure.options.size()) cure.text += ",";
    }
    return cure;
}

}  // namespace

Problem to_problem(const Error& error) {
    Problem problem;
    problem.type = to_string(error.kind);
    problem.detail = error.message;
    for (const KindRow& row : kTable) {
        if (row.kind != error.kind) continue;
        problem.status = row.status;
        problem.title = row.title;
    }
    if (error.kind == ErrorKind::invalid_argument) problem.type = "invalid-request";
    if (!error.cure.empty()) problem.cure = cure_of(error.cure);
    if (!error.where.empty()) problem.errors.push_back({to_pointer(error.where), error.message});
    return problem;
}

RecordSamples samples_of(const Record& record, std::size_t max) {
    std::vector<std::size_t> rows;
    for (std::size_t i = 0; i < record.t.size(); ++i) {
        if (std::isfinite(record.t[i]) && std::isfinite(record.u[i]) && std::isfinite(record.y[i])) rows.push_back(i);
    }
    RecordSamples samples{record.t.size(), {}, {}, {}};
    const std::size_t shown = std::min(rows.size(), max);
    for (std::size_t k = 0; k < shown; ++k) {
        const std::size_t i = rows[shown == 1 ? 0 : k * (rows.size() - 1) / (shown - 1)];
        samples.t.push_back(record.t[i]);
        samples.u.push_back(record.u[i]);
        samples.y.push_back(record.y[i]);
        if (!record.r.empty()) samples.r.push_back(record.r[i]);
    }
    if (const auto clean = clean_record(record)) samples.move_times = move_times(*clean);
    return samples;
}

// An excerpt is written in full precision: users check it digit by digit.
static void write_record(const RecordSamples& samples, Writer& out) {
    const bool excerpt = samples.t.size() <= kExcerptRows;
    const auto write = [&](const char* name, const std::vector<double>& values) {
        out.key(name);
        excerpt ? out.numbers(values) : out.trace(values);
    };
    out.key("record").begin_object();
    out.key("samples").integer(static_cast<long long>(samples.samples));
    out.key("t");
    excerpt ? out.numbers(samples.t) : out.times(samples.t);
    write("u", samples.u);
    write("y", samples.y);
    if (!samples.r.empty()) write("r", samples.r);
    out.key("move_times");
    out.numbers(samples.move_times);
    out.end_object();
}

static void write_cure(const Cure& cure, Writer& out) {
    out.key("cure").begin_object();
    out.key("text").text(cure.text);
    out.key("options").begin_object();
    for (const auto& [name, value] : cure.options) out.key(name).number(value);
    out.end_object();
    out.end_object();
}

std::string to_json(const Problem& problem) {
    Writer out;
    out.begin_object();
    out.key("type").text(problem.type);
    out.key("title").text(problem.title);
    out.key("status").integer(problem.status);
    out.key("detail").text(problem.detail);
    if (!problem.instance.empty()) out.key("instance").text(problem.instance);
    if (!problem.errors.empty()) {
        out.key("errors").begin_array();
        for (const FieldError& error : problem.errors) {
            out.begin_object();
            out.key("pointer").text(error.pointer);
            out.key("detail").text(error.detail);
            out.end_object();
        }
        out.end_array();
    }
    if (problem.cure) write_cure(*problem.cure, out);
    if (problem.record) write_record(*problem.record, out);
    out.end_object();
    return out.take();
}

}  // namespace tunewright::api
