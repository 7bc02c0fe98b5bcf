#include "api/report/report_input.h"

#include <limits>
#include <utility>

#include "api/contract/terms.h"
#include "engine/request/entry.h"
#include "engine/request/verdict/finding.h"

namespace tunewright::api {
namespace {

const Json kNone;

std::string label(const Json& units, const char* name, const char* fallback) {
    return units.is_object() && units.contains(name) && units[name].is_string()
               ? verdict::printed_unit(units[name].get<std::string>())
               : fallback;
}

}  // namespace

const Json& JsonLocation::value() const {
    const Json::json_pointer where(pointer);
    return root.contains(where) ? root.at(where) : kNone;
}

JsonLocation JsonLocation::at(std::string_view name) const { return {root, pointer + "/" + pointer_segment(name)}; }

JsonLocation JsonLocation::at(std::size_t index) const { return {root, pointer + "/" + std::to_string(index)}; }

std::string text_at(const JsonLocation& place) {
    const Json& value = place.value();
    return value.is_string() ? value.get<std::string>() : "";
}

std::vector<double> numbers_at(const JsonLocation& place) {
    std::vector<double> out;
    for (const Json& value : place.value())
        out.push_back(value.is_number() ? value.get<double>() : std::numeric_limits<double>::quiet_NaN());
    return out;
}

namespace {

ReportInput subject_at(const Json& document, std::string_view part) {
    const JsonLocation root{document, ""}, result = root.at("result");
    Json units = result.at("units").value();
    if (!units.is_object()) units = root.at("request").at("units").value();
    return {.result = result,
            .request = root.at("request"),
            .entry = result.at(part),
            .given = root.at(""),
            .index = 0,
            .today = {},
            .time = label(units, "time", "s"),
            .u = label(units, "u", ""),
            .y = label(units, "y", "")};
}

}  // namespace

ReportInput subject_of(const Json& document, std::size_t index) {
    const ReportInput all = subject_at(document, "controllers");
    ReportInput subject{.result = all.result,
                        .request = all.request,
                        .entry = all.entry.at(index),
                        .given = all.given,
                        .index = index,
                        .today = {},
                        .time = all.time,
                        .u = all.u,
                        .y = all.y};
    std::size_t given = 0;
    for (std::size_t i = 0; i < all.entry.value().size(); ++i) {
        const JsonLocation other = all.entry.at(i);
        const std::string method = text_at(other.at("method"));
        if (i != index && method == kBaselineMethod && other.at("controller").exists()) subject.today.emplace(other);
        if (method != kGivenMethod) continue;
        if (i == index) subject.given.pointer = all.request.at("controllers").at(given).pointer;
        ++given;
    }
    return subject;
}

ReportInput subject_of_range(const Json& document) { return subject_at(document, "range"); }

ReportInput subject_of_check(const Json& document) { return subject_at(document, "loops"); }

ReportInput subject_of_structure(const Json& document) { return subject_at(document, ""); }

ReportInput with_units(const ReportInput& subject, const Json& units) {
    ReportInput out = subject;
    if (!units.is_object()) return out;
    out.time = label(units, "time", "s");
    out.u = label(units, "u", "");
    out.y = label(units, "y", "");
    return out;
}

std::size_t best_proposal(const ChosenEntry& found) {
    const Json& controllers = found.result.at("controllers");
    const Json ranking = found.result.value("ranking", Json::array());
    for (const Json& number : ranking) {
        if (!number.is_number_unsigned() || number.get<std::size_t>() >= controllers.size()) continue;
        const Json& entry = controllers[number.get<std::size_t>()];
        if (entry.is_object() && entry.contains("controller") && entry.value("method", "") != kBaselineMethod)
            return number.get<std::size_t>();
    }
    return found.index;
}

Json document_of(ChosenEntry& found) {
    Json document = Json::object();
    document["result"] = std::move(found.result);
    // A printed request that is run again must not notify the webhook of its first sender.
    if (found.request.is_object()) leave_out_terms(found.request);
    document["request"] = std::move(found.request);
    return document;
}

}  // namespace tunewright::api
