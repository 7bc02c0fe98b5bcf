#include "api/outline.h"

#include <algorithm>

#include "api/contract/controller.h"
#include "api/contract/plant/plant.h"
#include "api/json/json.h"
#include "api/json/writer.h"
#include "engine/request/verdict/findings.h"

namespace tunewright::api {
namespace {

/// A longer plant is shown by its type alone.
constexpr std::size_t kLongestPlant = 300;
constexpr std::size_t kLongestError = 400;

template <class Contract, class Value>
std::string short_plant(const Contract& contract, const Value& plant) {
    Writer out;
    contract.write(plant, out);
    std::string text = out.take();
    if (text.size() <= kLongestPlant) return text;
    return Json{{"type", Json::parse(text).at("type")}}.dump();
}

bool is_todays(const TuningEntry& entry) { return entry.is_baseline(); }

/// The best controller that was tuned; null if there is none.
const TuningEntry* first_ranked(const TuningResult& result) {
    for (const int index : result.ranking) {
        const TuningEntry& entry = result.controllers.at(static_cast<std::size_t>(index));
        if (!is_todays(entry) && entry.evaluation) return &entry;
    }
    return nullptr;
}

void write_figure(const char* name, const Figure& figure, Writer& out) {
    out.key(name);
    figure ? out.number(*figure) : out.null();
}

void write_figures(const TuningEntry& entry, Writer& out) {
    write_figure("Ms", verdict::robustness_of(entry).Ms, out);
    write_figure("load_IAE", verdict::performance_of(entry).load.IAE, out);
}

/// Writes the settings: the controller, and the texts to type if it is in a product.
void write_settings(const TuningEntry& entry, Writer& out) {
    out.key("controller");
    controller_contract().write(entry.evaluation->controller, out);
    if (!entry.on_device || entry.on_device->fitted.typed.empty()) return;
    const device::Fitted& fitted = entry.on_device->fitted;
    out.key("to_type").begin_object();
    for (const product::Setting& setting : fitted.typed) {
        const product::Parameter* parameter = product::parameter_named(*fitted.product, setting.name);
        const std::string unit(parameter == nullptr ? "" : parameter->unit);
        out.key(setting.name).text(product::typed_text(*fitted.product, setting) + (unit.empty() ? "" : " " + unit));
    }
    out.end_object();
}

void write_best(const TuningEntry& best, Writer& out) {
    out.key("method").text(best.method);
    write_settings(best, out);
    write_figures(best, out);
    if (best.standing && (best.evaluation->region || best.on_device)) write_figure("worst_Ms", best.standing->Ms, out);
    if (best.optimum_at_Ms) write_figure("excess_percent", best.optimum_at_Ms->excess_percent, out);
}

}  // namespace

Outline::Outline(const JobRequest& request) {
    if (request.units) {
        Writer out;
        units_contract().write(*request.units, out);
        units_ = out.take();
    }
    if (request.plant) plant_ = short_plant(plant_model_contract(), *request.plant);
    if (request.ultimate)
        plant_ = Json{{"type", "ultimate"}, {"Ku", request.ultimate->Ku}, {"Pu", request.ultimate->Pu}}.dump();
}

std::string Outline::of(const TuningResult& result) const {
    Writer out;
    out.begin_object();
    out.key("plant").raw(result.model ? short_plant(plant_contract(), result.model->plant) : plant_);
    if (result.model) out.key("record").boolean(true);
    if (!units_.empty()) out.key("units").raw(units_);
    out.key("entries").integer(
        std::ranges::count_if(result.controllers, [](const TuningEntry& entry) { return !is_todays(entry); }));
    if (const TuningEntry* best = first_ranked(result)) write_best(*best, out);
    const auto today = std::ranges::find_if(result.controllers, is_todays);
    if (today != result.controllers.end() && today->evaluation) {
        out.key("today").begin_object();
        write_settings(*today, out);
        write_figures(*today, out);
        out.end_object();
    }
    out.end_object();
    return out.take();
}

std::string error_outline(const std::string& problem_json) {
    const Json problem = Json::parse(problem_json, nullptr, false);
    std::string detail = problem.is_object() ? problem.value("detail", "") : "";
    if (problem.is_object() && problem.contains("errors") && problem["errors"].size() == 1)
        detail = problem["errors"][0].value("detail", detail);
    if (detail.size() > kLongestError) {
        detail.resize(kLongestError);
        while (!detail.empty() && (static_cast<unsigned char>(detail.back()) & 0x80U) != 0) detail.pop_back();
        detail += "...";
    }
    return Json{{"error", detail}}.dump();
}

}  // namespace tunewright::api
