#include "api/contract/plant/typed.h"

#include "api/describe/description.h"
#include "engine/plant/nonlinear/nonlinear_plant.h"

namespace tunewright::api {
namespace {

constexpr std::size_t kMaxStates = 20, kMaxParameters = 200;
constexpr std::size_t kMaxSymbolLength = 60, kMaxExpressionLength = 10'000;

Json expression_schema() { return {{"type", "string"}, {"maxLength", kMaxExpressionLength}}; }

Json by_name_schema(Json value, std::size_t least, std::size_t most) {
    return {{"type", "object"},
            {"additionalProperties", std::move(value)},
            {"propertyNames", {{"maxLength", kMaxSymbolLength}}},
            {"minProperties", least},
            {"maxProperties", most}};
}

std::string count_fault(const Json& value, std::size_t least, std::size_t most, const Reader& reader) {
    return reader.name() + " has " + std::to_string(value.size()) + " members; it must have " + std::to_string(least) +
           " to " + std::to_string(most) + ".";
}

// An object whose members have names of the user's own; `read_member` returns nothing after a fault.
template <class Member, class ReadMember>
auto members_by_name(std::size_t least, std::size_t most, const char* sample, ReadMember read_member) {
    return [=](const Json& value, std::vector<Member>& target, Reader& reader) {
        if (!value.is_object())
            return reader.fault(wrong_kind(value, std::string("an object such as ") + sample, reader));
        if (value.size() < least || value.size() > most) return reader.fault(count_fault(value, least, most, reader));
        for (const auto& [name, content] : value.items()) {
            const Reader::At at(reader, name);
            if (name.size() > kMaxSymbolLength) {
                reader.fault("A name has " + std::to_string(name.size()) + " characters; it may have " +
                             std::to_string(kMaxSymbolLength) + ".");
            } else if (const auto member = read_member(content, reader)) {
                target.push_back({name, *member});
            }
        }
    };
}

std::optional<double> read_value(const Json& value, Reader& reader) { return read_number(value, {}, reader); }

std::optional<std::string> read_expression(const Json& value, Reader& reader) {
    const std::size_t before = reader.count();
    std::string content;
    text(kMaxExpressionLength).read(value, content, reader);
    return reader.clean_since(before) ? std::optional(content) : std::nullopt;
}

std::optional<std::variant<double, std::string>> read_parameter(const Json& value, Reader& reader) {
    if (value.is_string()) return read_expression(value, reader);
    return read_number(value, {.cure = "An expression in other parameters is possible too, as a text."}, reader);
}

template <class Member, class WriteMember>
auto write_by_name(WriteMember write_member) {
    return [=](const std::vector<Member>& members, Writer& out) {
        out.begin_object();
        for (const Member& member : members) {
            out.key(member.name);
            write_member(member, out);
        }
        out.end_object();
    };
}

Codec<std::vector<NamedValue>> states() {
    return {members_by_name<NamedValue>(1, kMaxStates, "{\"h\": 2.5}", read_value),
            write_by_name<NamedValue>([](const NamedValue& state, Writer& out) { out.number(state.value); }),
            [](SchemaBook&) {
                return by_name_schema({{"type", "number"}}, 1, kMaxStates);
            }};
}

Codec<std::vector<NamedExpression>> equations() {
    return {members_by_name<NamedExpression>(1, kMaxStates, R"({"h": "(q - k*sqrt(h))/A"})", read_expression),
            write_by_name<NamedExpression>([](const NamedExpression& e, Writer& out) { out.text(e.text); }),
            [](SchemaBook&) { return by_name_schema(expression_schema(), 1, kMaxStates); }};
}

Codec<std::vector<Parameter>> parameters() {
    const auto write = [](const Parameter& parameter, Writer& out) {
        if (const double* number = std::get_if<double>(&parameter.value)) return out.number(*number);
        out.text(std::get<std::string>(parameter.value));
    };
    return {members_by_name<Parameter>(0, kMaxParameters, R"({"A": 0.5, "k": "2*A"})", read_parameter),
            write_by_name<Parameter>(write),
            [](SchemaBook&) {
                return by_name_schema({{"oneOf", Json::array({Json{{"type", "number"}}, expression_schema()})}}, 0,
                                      kMaxParameters);
            },
            [](const std::vector<Parameter>& given) { return given.empty(); }};
}

const Description<ManipulatedInput>& input_contract() {
    static const auto description = [] {
        Description<ManipulatedInput> d("ManipulatedInput",
                                        "The input that the controller moves; all values are absolute.");
        d.field("name", &ManipulatedInput::name, text(kMaxSymbolLength), "Its name in the equations.")
            .field("nominal", &ManipulatedInput::nominal, number(), "Its value at the operating point.",
                   {.required = true, .unit = "u"})
            .field("min", &ManipulatedInput::min, maybe(number()), "Its lower limit, <= nominal.", {.unit = "u"})
            .field("max", &ManipulatedInput::max, maybe(number()), "Its upper limit, >= nominal.", {.unit = "u"});
        return d;
    }();
    return description;
}

const Description<NonlinearPlant>& nonlinear_plant_contract() {
    static const auto description = [] {
        using P = NonlinearPlant;
        Description<P> d("NonlinearPlant",
                         "Differential equations in text. Methods work on the linearisation about the steady state; "
                         "responses and their figures are the nonlinear plant's own. In expressions: + - * / ^, "
                         "comparisons, condition ? a : b, exp log sqrt sin cos tan tanh abs min max.");
        d.tag("type", "nonlinear")
            .field("states", &P::states, states(),
                   "Each state's value near the operating point, which is refined to a steady state of the nominal "
                   "input.",
                   {.required = true})
            .field("parameters", &P::parameters, parameters(),
                   "Constants of the equations: numbers, or expressions in other parameters.")
            .field("equations", &P::equations, equations(),
                   "The derivative of each state over time, in states, parameters and the input.", {.required = true})
            .field("input", &P::input, object(input_contract()), "The manipulated input.", {.required = true})
            .field("output", &P::output, text(kMaxExpressionLength),
                   "The controlled quantity, in states and parameters; not in the input.",
                   {.required = true, .unit = "y"})
            .field("L", &P::L, number({.minimum = 0, .cure = "A dead time cannot be negative."}),
                   "Dead time of the input, >= 0.", {.unit = "time"})
            .example({{"type", "nonlinear"},
                      {"states", {{"h", 0.5}}},
                      {"parameters", {{"A", 0.5}, {"k", 0.1}}},
                      {"equations", {{"h", "(q - k*sqrt(h))/A"}}},
                      {"input", {{"name", "q"}, {"nominal", 0.07}, {"min", 0}}},
                      {"output", "h"}});
        return d;
    }();
    return description;
}

const Description<PlantSet>& plant_set() {
    constexpr std::size_t kMaxPlants = 50;
    static const auto description = [] {
        Description<PlantSet> d("PlantSet", "Plants that one controller must serve: limits hold on all of them.");
        d.tag("type", "set")
            .field("plants", &PlantSet::plants, list_of(plant_or_text(), 1, kMaxPlants),
                   "Linear plants; the first is nominal: the objective and all figures are its own.",
                   {.required = true})
            .example({{"type", "set"},
                      {"plants", Json::array({Json{{"type", "fopdt"}, {"K", 2}, {"T", 10}, {"L", 3}},
                                              Json{{"type", "fopdt"}, {"K", 2.5}, {"T", 8}, {"L", 4}}})}});
        return d;
    }();
    return description;
}

// What belongs together in the points.
void check_points(const Json&, FrequencyResponse& points, Reader& reader) {
    if (const auto fault = points_fault(points)) reader.fault_below(fault->where, 1, fault->message);
}

const Description<FrequencyResponse>& frequency_response() {
    constexpr std::size_t kMin = 8, kMax = 10'000;
    constexpr int kMaxPoles = 20;
    static const auto description = [] {
        using F = FrequencyResponse;
        Description<F> d("FrequencyResponse",
                         "Measured points of P(j omega). Figures over time are null, and robust maximises Kp/Ti.");
        d.tag("type", "frequency_response")
            .field("omega", &F::omega, numbers(kMin, kMax),
                   "Angular frequencies, ascending; they must reach beyond the phase crossover.",
                   {.required = true, .unit = "rad/time"})
            .field("re", &F::re, numbers(kMin, kMax), "Real parts, one a frequency.", {.required = true, .unit = "y/u"})
            .field("im", &F::im, numbers(kMin, kMax), "Imaginary parts, one a frequency.",
                   {.required = true, .unit = "y/u"})
            .field("unstable_poles", &F::unstable_poles, integer(0, kMaxPoles),
                   "Poles of the plant in the open right half-plane, which the points cannot tell.")
            .field("integrators", &F::integrators, integer(0, kMaxPoles), "Poles of the plant at s = 0.")
            .check(check_points)
            .example(
                {{"type", "frequency_response"},
                 {"omega", {0.02, 0.05, 0.1, 0.2, 0.3, 0.45, 0.7, 1, 1.5}},
                 {"re", {1.89655, 1.46248, 0.659816, -0.12158, -0.345674, -0.392635, -0.261892, -0.0475484, 0.127895}},
                 {"im",
                  {-0.499239, -1.03012, -1.25086, -0.886125, -0.529631, -0.184589, 0.106829, 0.193244, 0.0366325}}});
        return d;
    }();
    return description;
}

}  // namespace

const Union<PlantModel>& plant_model_contract() {
    static const auto contract = [] {
        Union<PlantModel> plant("PlantModel",
                                "One linear plant, several that one controller must serve, measured points of one, or "
                                "differential equations.",
                                "type");
        plant.include(plant_contract())
            .alternative(plant_set())
            .alternative(frequency_response())
            .alternative(nonlinear_plant_contract());
        return plant;
    }();
    return contract;
}

}  // namespace tunewright::api
