#include "engine/request/plan.h"

#include <algorithm>

#include "engine/tuning/method/rule.h"
#include "engine/tuning/registry.h"

namespace tunewright {
namespace {

Error unknown_method(const std::string& id, const std::string& where) {
    std::string known;
    for (const auto& method : method_registry()) known += method.id + ", ";
    return {ErrorKind::invalid_argument, where + "/method",
            "method is \"" + id + "\"; it must be one of " + known + "or all."};
}

}  // namespace

Expected<std::vector<PlannedRow>> plan_rows(const std::vector<MethodRequest>& requests) {
    std::vector<PlannedRow> planned;
    for (std::size_t i = 0; i < requests.size(); ++i) {
        const std::string where = "tune/" + std::to_string(i);
        if (requests[i].of_all()) {
            for (PlannedRow& row : comparison_rows(requests[i].options)) {
                row.where = where;
                planned.push_back(std::move(row));
            }
            continue;
        }
        const TuningMethod* method = find_method(requests[i].method);
        if (!method) return unknown_method(requests[i].method, where);
        planned.push_back({method, requests[i].options, "", {}, where});
    }
    return planned;
}

namespace {

std::string first_name(const std::string& path) { return path.substr(0, path.find('/')); }

// A method gives one row for each of its controllers with integral action: without it a load leaves a lasting error.
std::vector<MethodVariant> variants_of(const TuningMethod& method) {
    if (!method.variants.empty()) return method.variants;
    std::vector<MethodVariant> variants;
    if (const OptionDescription* controller = named(method.options, kControllerOption)) {
        for (const std::string& choice : controller->choices) {
            if (choice == "P") continue;
            variants.push_back({choice, {}});
            variants.back().options.set(kControllerOption, choice);
        }
    }
    if (variants.empty()) variants.push_back({});
    return variants;
}

Error unsuitable(const std::string& path, const std::string& message) {
    return {ErrorKind::unsupported, path, message};
}

// The given options that the method has, or the error in them.
Expected<MethodOptions> known_options(const MethodOptions& given, const TuningMethod& method) {
    MethodOptions known;
    for (const auto& [path, value] : given.values()) {
        if (!named(method.options, first_name(path))) {
            if (path != kControllerOption || value == OptionValue(std::string("PID"))) continue;
            return unsuitable(path, method.id + " tunes PID controllers only, but " + std::get<std::string>(value) +
                                        " was "
                                        "requested.");
        }
        if (const auto fault = misfit(method.options, path, value))
            return unsuitable(path, method.id + " cannot be used here: " + *fault);
        known.set(path, value);
    }
    return known;
}

bool contradicts(const MethodOptions& variant, const MethodOptions& given) {
    return std::ranges::any_of(variant.values(), [&](const auto& item) {
        const auto at = given.values().find(item.first);
        return at != given.values().end() && at->second != item.second;
    });
}

}  // namespace

std::string PlannedRow::title(const std::string& besides) const {
    const std::string all = variant + (variant.empty() || besides.empty() ? "" : ", ") + besides;
    return all.empty() ? method->title : method->title + " (" + all + ")";
}

std::vector<PlannedRow> comparison_rows(const MethodOptions& given) {
    std::vector<PlannedRow> rows;
    for (const TuningMethod& method : method_registry()) {
        if (!method.compared) continue;
        const auto known = known_options(given, method);
        if (!known) {
            rows.push_back({&method, {}, "", known.error(), {}, true});
            continue;
        }
        const std::size_t before = rows.size();
        for (const MethodVariant& variant : variants_of(method)) {
            if (contradicts(variant.options, *known)) continue;
            MethodOptions options = variant.options;
            for (const auto& [path, value] : known->values()) options.set(path, value);
            rows.push_back(
                {&method, std::move(options), variant.name, {}, {}, true, method.holds_family || known->has("Ms")});
        }
        if (rows.size() > before) continue;
        const auto controller = known->text(kControllerOption);
        rows.push_back({&method, *known, controller.value_or(""), {}, {}, true});
    }
    return rows;
}

Error all_failed(const std::vector<TuningEntry>& entries) {
    std::vector<std::pair<std::string, std::string>> reasons;  // methods, reason
    for (const auto& entry : entries) {
        const auto at = std::ranges::find(reasons, entry.error->message, &std::pair<std::string, std::string>::second);
        if (at == reasons.end())
            reasons.emplace_back(entry.method, entry.error->message);
        else if (!(", " + at->first).ends_with(", " + entry.method))
            at->first += ", " + entry.method;
    }
    Error error = *entries.front().error;
    if (reasons.size() == 1) return error;
    const auto cured = std::ranges::find_if(entries, [](const TuningEntry& one) { return !one.error->cure.empty(); });
    if (cured != entries.end()) error.cure = cured->error->cure;
    error.message = "No method gave a controller.";
    for (const auto& [methods, reason] : reasons) error.message.append(" ").append(methods).append(": ").append(reason);
    return error;
}

}  // namespace tunewright
