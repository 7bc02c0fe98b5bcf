#include "api/contract/structure/structure_parts.h"

#include <algorithm>
#include <variant>

#include "api/contract/controller.h"
#include "api/contract/plant/typed.h"
#include "api/contract/product/conversion.h"

namespace tunewright::api {
namespace {

constexpr std::size_t kMostControllers = 3;

bool is_uncertain(const Plant& plant) {
    return std::visit([](const auto& one) { return !one.uncertainty.empty(); }, plant);
}

}  // namespace

Codec<std::optional<LinearPlant>> linear_plant() {
    const auto inner = plant_or_text();
    Codec<std::optional<LinearPlant>> codec;
    codec.read = [inner](const Json& value, std::optional<LinearPlant>& target, Reader& reader) {
        const std::size_t before = reader.count();
        Plant plant;
        inner.read(value, plant, reader);
        if (!reader.clean_since(before)) return;
        if (is_uncertain(plant))
            return reader.fault_at("uncertainty",
                                   "uncertainty is not supported here. Leave it out: the nominal plant is taken.");
        auto linear = LinearPlant::make(plant);
        if (!linear) return reader.fault_below(linear.error().where, 1, linear.error().message);
        target = std::move(*linear);
    };
    codec.schema = inner.schema;
    codec.skip = [](const auto& plant) { return !plant; };
    return codec;
}

Codec<std::optional<IdealPid>> linear_controller() {
    const auto inner = one_of(controller_contract());
    Codec<std::optional<IdealPid>> codec;
    codec.read = [inner](const Json& value, std::optional<IdealPid>& target, Reader& reader) {
        const std::size_t before = reader.count();
        Controller controller;
        inner.read(value, controller, reader);
        if (!reader.clean_since(before)) return;
        if (std::holds_alternative<Npid>(controller))
            return reader.fault_at("form", "form is npid; only linear forms are supported here. Give the form ideal.");
        auto ideal = to_ideal(controller);
        if (!ideal) return reader.fault(ideal.error().message);
        target = *ideal;
    };
    codec.schema = inner.schema;
    codec.skip = [](const auto& pid) { return !pid; };
    return codec;
}

Codec<IdealPid> ideal_controller() {
    Codec<IdealPid> codec;
    codec.write = [](const IdealPid& pid, Writer& out) { controller_contract().write(Controller(pid), out); };
    codec.schema = one_of(controller_contract()).schema;
    return codec;
}

const Description<structure::LoopDesign>& loop_design_contract() {
    static const auto description = [] {
        using D = structure::LoopDesign;
        const NumberRule limit{.exclusive_minimum = 1, .maximum = limits::kMaxMs};
        Description<D> d("LoopDesign", "The design of one loop: the least IAE of a load step within limits.");
        d.field(
             "method",
             [](const Json& value, D&, Reader& reader) {
                 if (value != "robust") reader.fault("method is " + shown(value) + "; only robust is supported here.");
             },
             {},
             [](SchemaBook&) {
                 return Json{{"const", "robust"}, {"default", "robust"}};
             },
             "The method.")
            .field("controller", &D::controller,
                   choice<ControllerKind>({{"PI", ControllerKind::PI}, {"PID", ControllerKind::PID}}),
                   "The type of controller.")
            .field("Ms", &D::Ms, number(limit), "Limit on max |S|.")
            .field("Mt", &D::Mt, number(limit), "Limit on max |T|.");
        return d;
    }();
    return description;
}

Figure known_unless(const Figure& value, const std::string& why) { return why.empty() ? value : no_figure(why); }

Codec<double> finite_figure(std::string why) {
    return computed_figure<double>([why](const double& value) { return finite_or(value, why); });
}

Codec<double> peak_figure() {
    return computed_figure<double>(
        [](const double& value) { return value > 0 ? Figure(value) : no_figure("The loop is not stable."); });
}

StepView::StepView(const Figure& IAE, const Figure& IE, double peak, double TV, const std::string& why)
    : IAE(known_unless(IAE, why)),
      IE(known_unless(IE, why)),
      peak(known_unless(peak, why)),
      TV(known_unless(TV, why)) {}

const Description<StepView>& step_view_contract() {
    static const auto description = [] {
        Description<StepView> d("StructureStep", "Figures after a unit step.");
        d.field("IAE", &StepView::IAE, figure(), "Integral of the error's magnitude.")
            .field("IE", &StepView::IE, figure(), "Integral of the error.")
            .field("peak", &StepView::peak, figure(),
                   "After a load: y farthest from 0. After a set-point step: the overshoot, as a share of it.")
            .field("TV", &StepView::TV, figure(), "Total variation of u.")
            .why_null("The loops are not stable.");
        return d;
    }();
    return description;
}

namespace {

/// An object of figures with any names.
Json any_figures_schema(SchemaBook&) {
    return {{"type", "object"},
            {"properties", {{"why_null", {{"type", "object"}, {"additionalProperties", {{"type", "string"}}}}}}},
            {"additionalProperties", {{"type", {"number", "null"}}}}};
}

}  // namespace

const Description<structure::Conclusion>& conclusion_contract() {
    static const auto description = [] {
        using C = structure::Conclusion;
        Words<structure::ConclusionCode> words;
        for (const auto code : structure::all_conclusion_codes()) words.emplace_back(to_string(code), code);
        Description<C> d("Conclusion", "A conclusion from the figures of the answer.");
        d.field("code", &C::code, only_answered(choice<structure::ConclusionCode>(words)), "What holds.")
            .field(
                "figures", {},
                [](const C& c, Writer& out) {
                    write_figures(out, {c.figures.begin(), c.figures.end()});
                },
                any_figures_schema, "Its figures by name.");
        return d;
    }();
    return description;
}

Json figures_schema(std::initializer_list<const char*> names) {
    Json properties = Json::object(), required = Json::array();
    for (const char* name : names) {
        properties[name] = {{"type", {"number", "null"}}};
        required.push_back(name);
    }
    properties["why_null"] = {{"type", "object"}, {"additionalProperties", {{"type", "string"}}}};
    return {{"type", "object"}, {"properties", properties}, {"required", required}};
}

void write_figures(Writer& out, const std::vector<std::pair<std::string, Figure>>& figures) {
    out.begin_object();
    bool unknown = false;
    for (const auto& [name, value] : figures) {
        out.key(name);
        figure().write(value, out);
        unknown = unknown || !value;
    }
    if (unknown) {
        out.key("why_null").begin_object();
        for (const auto& [name, value] : figures)
            if (!value) out.key(name).text(value.why);
        out.end_object();
    }
    out.end_object();
}

namespace {

struct DrawingWish {
    int points = 200;
};

const Description<DrawingWish>& drawing_wish_contract() {
    static const auto description = [] {
        Description<DrawingWish> d("StructureEvaluate", "What is drawn.");
        d.field("points", &DrawingWish::points, trace_points(), "Points of each series; 0: no series.");
        return d;
    }();
    return description;
}

}  // namespace

Codec<std::optional<Units>> units_with_level() {
    auto codec = maybe(object(units_contract()));
    codec.read = [inner = codec.read](const Json& value, std::optional<Units>& units, Reader& reader) {
        if (!value.is_object() || !value.contains("level") || value.contains("y")) return inner(value, units, reader);
        Json renamed = value;
        renamed["y"] = value["level"];
        renamed.erase("level");
        inner(renamed, units, reader);
    };
    return codec;
}

Codec<StructureRequest> drawing_wish() {
    const auto inner = object(drawing_wish_contract());
    Codec<StructureRequest> codec;
    codec.read = [inner](const Json& value, StructureRequest& request, Reader& reader) {
        DrawingWish wish;
        inner.read(value, wish, reader);
        request.points = wish.points;
    };
    codec.schema = inner.schema;
    return codec;
}

Codec<StructureRequest> devices_wish() {
    const auto one = object(implement_contract());
    const auto several = list_of(one, 1, kMostControllers);
    Codec<StructureRequest> codec;
    codec.read = [one, several](const Json& value, StructureRequest& request, Reader& reader) {
        if (value.is_array()) return several.read(value, request.implement, reader);
        request.implement.emplace_back();
        one.read(value, request.implement.back(), reader);
    };
    codec.schema = [one, several](SchemaBook& book) {
        return Json{{"oneOf", Json::array({one.schema(book), several.schema(book)})}};
    };
    return codec;
}

void resolve_devices(StructureRequest& request, Reader& reader) {
    const std::string time = request.time_unit();
    const Reader::At at(reader, "implement");
    for (std::size_t i = 0; i < request.implement.size(); ++i) {
        const GivenDevice& given = request.implement[i];
        if (given.product && !seconds_per_time(time, reader)) return;
        auto device = device_of(given, time, reader);
        if (!device) return;
        check_needs(*device, reader);
        request.devices.push_back(std::move(*device));
    }
}

void check_device_count(const StructureRequest& request, std::size_t controllers, Reader& reader) {
    const std::size_t given = request.implement.size();
    if (given <= 1 || given == controllers) return;
    const std::string rest =
        controllers == 1 ? "." : " for all, or " + std::to_string(controllers) + ", one for each controller.";
    reader.fault_at("implement", "implement has " + std::to_string(given) + " entries; give 1" + rest);
}

const Description<StructureTyping>& structure_typing_contract() {
    static const auto description = [] {
        using T = StructureTyping;
        Description<T> d("StructureTyping", "What is typed for one controller of a structure.");
        d.field("loop", &T::loop, words(), "The controller.")
            .field(
                "typing", {},
                [](const T& t, Writer& out) {
                    if (!t.fitted) return out.null();
                    settings_answer_contract().write({t.fitted->product,
                                                      t.fitted->settings,
                                                      t.fitted->typed,
                                                      t.fitted->controller,
                                                      t.fitted->notes,
                                                      t.fitted->context,
                                                      {}},
                                                     out);
                },
                [](SchemaBook& book) { return or_null(answer(settings_answer_contract()).schema)(book); },
                "The settings, as POST /v1/controllers/{id}/settings answers.")
            .field(
                "why", {}, [](const T& t, Writer& out) { out.text(t.fitted.why); }, words().schema,
                "Why there are none.", {}, [](const T& t) { return bool(t.fitted); });
        return d;
    }();
    return description;
}

const Description<NamedModel>& named_model_contract() {
    static const auto description = [] {
        Description<NamedModel> d("StructureModel", "A model from a record.");
        d.field("name", &NamedModel::name, words(), "What it is of.")
            .field("model", &NamedModel::model, answer(model_contract()), "As POST /v1/identify answers.");
        return d;
    }();
    return description;
}

namespace {

Json series_schema() { return {{"type", "array"}, {"items", {{"type", "number"}}}}; }

Json list_schema(const Json& properties) {
    Json required = Json::array();
    for (const auto& [name, schema] : properties.items()) required.push_back(name);
    return {{"type", "array"}, {"items", {{"type", "object"}, {"properties", properties}, {"required", required}}}};
}

}  // namespace

namespace {

/// Every n-th call, so that at most `points` are left.
std::vector<double> thinned(const std::vector<double>& all, int points) {
    std::vector<double> out;
    if (points == 0) return out;
    const std::size_t stride = (all.size() + std::size_t(points) - 1) / std::size_t(points);
    for (std::size_t i = 0; i < all.size(); i += std::max<std::size_t>(stride, 1)) out.push_back(all[i]);
    return out;
}

void write_sampled_response(const SampledView& view, const structure::SampledResponse& response, Writer& out) {
    out.begin_object();
    out.key("input").text(response.name);
    out.key("figures").begin_array();
    const bool moves_setpoint = response.name.starts_with("setpoint");
    for (const structure::StepFigures& f : response.figures)
        step_view_contract().write(
            {f.IAE, f.IE, moves_setpoint ? f.overshoot : f.peak, f.TV,
             f.settles ? "" : "The response does not settle; if the loops are stable, call them less often."},
            out);
    out.end_array();
    out.key("largest_rate").number(response.largest_rate);
    std::vector<double> t;
    for (std::size_t k = 0; k < response.y.front().size(); ++k) t.push_back(double(k) * view.sample_time);
    out.key("t").numbers(thinned(t, view.points));
    out.key("signals").begin_array();
    for (std::size_t i = 0; i < view.names.size(); ++i) {
        const bool measured = i < response.y.size();
        out.begin_object();
        out.key("name").text(view.names[i]);
        out.key("values").numbers(thinned(measured ? response.y[i] : response.u[i - response.y.size()], view.points));
        out.end_object();
    }
    out.end_array();
    out.end_object();
}

Json sampled_responses_schema(SchemaBook& book) {
    const Json text{{"type", "string"}}, number{{"type", "number"}};
    return list_schema({{"input", text},
                        {"figures", {{"type", "array"}, {"items", step_view_contract().schema(book)}}},
                        {"largest_rate", number},
                        {"t", series_schema()},
                        {"signals", list_schema({{"name", text}, {"values", series_schema()}})}});
}

}  // namespace

const Description<SampledView>& sampled_view_contract() {
    static const auto description = [] {
        using V = SampledView;
        Description<V> d("StructureSampledAnswer", "The loops with the program of their controllers.");
        d.field("sample_time", &V::sample_time, only_answered(number()), "Time from one call to the next.",
                {.unit = "time"})
            .field(
                "Ms", {},
                [](const V& v, Writer& out) {
                    write_figures(out, {v.answer.Ms.begin(), v.answer.Ms.end()});
                },
                any_figures_schema, "Peak of the sampled loop at each place, without limits.")
            .field(
                "responses", {},
                [](const V& v, Writer& out) {
                    out.begin_array();
                    for (const auto& response : v.answer.responses) write_sampled_response(v, response, out);
                    out.end_array();
                },
                sampled_responses_schema,
                "With the limits; figures of each measurement that has a set point; largest_rate: of u from call to "
                "call.");
        return d;
    }();
    return description;
}

void take_record(StructureRequest& request, std::string name, std::string where, GivenRecord given, std::size_t further,
                 const char* needs, Reader& reader) {
    const std::size_t before = reader.count();
    const bool in_csv = given.csv.has_value();
    ReadRecord read = resolve(std::move(given), request.units.value_or(Units{}), reader);
    if (!reader.clean_since(before)) return;
    if (read.record.d.size() != further) return reader.fault_at(in_csv ? "columns" : "d", needs);
    request.records.push_back({std::move(name), std::move(where), std::move(read)});
}

void write_responses(const structure::StructureDrawing& drawing, Writer& out) {
    out.begin_array();
    for (const structure::DrawnResponse& response : drawing.responses) {
        out.begin_object();
        out.key("of").text(response.of);
        out.key("input").text(response.input);
        out.key("t").numbers(response.t);
        out.key("signals").begin_array();
        for (std::size_t k = 0; k < response.names.size(); ++k) {
            out.begin_object();
            out.key("name").text(response.names[k]);
            out.key("values").numbers(response.values[k]);
            out.end_object();
        }
        out.end_array();
        out.end_object();
    }
    out.end_array();
}

Json responses_schema(SchemaBook&) {
    const Json text{{"type", "string"}};
    return list_schema({{"of", text},
                        {"input", text},
                        {"t", series_schema()},
                        {"signals", list_schema({{"name", text}, {"values", series_schema()}})}});
}

void write_curves(const structure::StructureDrawing& drawing, Writer& out) {
    out.begin_object();
    out.key("omega").numbers(drawing.omega);
    out.key("curves").begin_array();
    for (const structure::DrawnCurve& curve : drawing.curves) {
        out.begin_object();
        out.key("of").text(curve.of);
        out.key("loop").text(curve.loop);
        if (curve.limit) out.key("limit").number(*curve.limit);
        out.key("values").numbers(curve.values);
        out.end_object();
    }
    out.end_array();
    out.end_object();
}

Json curves_schema(SchemaBook&) {
    const Json text{{"type", "string"}};
    Json curves = list_schema({{"of", text}, {"loop", text}, {"values", series_schema()}});
    curves["items"]["properties"]["limit"] = {{"type", "number"}};
    return {{"type", "object"},
            {"properties", {{"omega", series_schema()}, {"curves", curves}}},
            {"required", {"omega", "curves"}}};
}

}  // namespace tunewright::api
