#include "api/contract/structure/structure_parts.h"

#include <variant>

#include "api/contract/controller.h"
#include "api/contract/plant/typed.h"

namespace tunewright::api {
namespace {

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

Figure known_unless(double value, const std::string& why) {
    return why.empty() ? finite_or(value, "It is infinite.") : no_figure(why);
}

StepView::StepView(double IAE, double IE, double peak, double TV, const std::string& why)
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

const Description<structure::Conclusion>& conclusion_contract() {
    static const auto description = [] {
        using C = structure::Conclusion;
        Words<structure::ConclusionCode> words;
        for (const auto code : structure::all_conclusion_codes()) words.emplace_back(to_string(code), code);
        Description<C> d("Conclusion", "A conclusion from the figures of the answer.");
        d.field("code", &C::code, only_answered(choice<structure::ConclusionCode>(words)), "What holds.")
            .field("figures", &C::figures, numbers_by_name("Names of figures."), "Its figures by name.");
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

void write_figures(Writer& out, std::initializer_list<std::pair<const char*, Figure>> figures) {
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

}  // namespace tunewright::api
