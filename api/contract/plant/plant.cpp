#include "api/contract/plant/plant.h"

#include <algorithm>

#include "api/contract/plant/typed.h"
#include "api/describe/description.h"
#include "engine/plant/linear/factor.h"
#include "engine/plant/nonlinear/nonlinear_plant.h"

namespace tunewright::api {
namespace {

constexpr std::size_t kMaxOrder = 50;

// The range of the number (plant_faults of engine/plant/linear/factor.h), as the schema shows it.
Codec<double> gain() { return engine_ruled({.not_zero = true}); }
Codec<double> dead_time() { return engine_ruled({.minimum = 0}); }

using Range = std::optional<FactorRange>;

// An interval [low, high] around 1.
Codec<Range> factors() {
    return {[](const Json& value, Range& target, Reader& reader) {
                if (!value.is_array() || value.size() != 2)
                    return reader.fault(wrong_kind(value, "a pair [low, high] of factors such as [0.8, 1.2]", reader));
                FactorRange range;
                for (const std::size_t i : {0, 1}) {
                    const Reader::At at(reader, i);
                    const auto read = read_number(value[i], {}, reader);
                    if (!read) return;
                    (i == 0 ? range.low : range.high) = *read;
                }
                target = range;
            },
            [](const Range& range, Writer& out) {
                out.begin_array();
                out.number(range->low);
                out.number(range->high);
                out.end_array();
            },
            [](SchemaBook&) {
                const Json factor{{"type", "number"}, {"exclusiveMinimum", 0}};
                return Json{{"type", "array"}, {"items", factor}, {"minItems", 2}, {"maxItems", 2}};
            },
            [](const Range& range) { return !range; }};
}

// The codec of the parameters that the plant type has.
template <class T>
const Description<Uncertainty>& uncertainty_contract(const std::string& type) {
    static const auto description = [&] {
        Description<Uncertainty> d(type + "Uncertainty",
                                   "Factors [low, high] of nominal values, low <= 1 <= high: limits hold on the "
                                   "corners, the centre and the worst point found inside.");
        d.field("K", &Uncertainty::K, factors(), "Factors of the plant's gain.");
        if constexpr (requires(T plant) { plant.T; }) d.field("T", &Uncertainty::T, factors(), "Factors of T.");
        if constexpr (requires(T plant) { plant.T1; }) {
            d.field("T1", &Uncertainty::T1, factors(), "Factors of T1.");
            d.field("T2", &Uncertainty::T2, factors(), "Factors of T2.");
        }
        d.field("L", &Uncertainty::L, factors(), "Factors of the dead time.");
        d.example({{"K", {0.8, 1.2}}, {"L", {0.9, 1.2}}});
        return d;
    }();
    return description;
}

template <class T>
Codec<Uncertainty> uncertainty(const std::string& type) {
    return unless<Uncertainty>(object(uncertainty_contract<T>(type)),
                               [](const Uncertainty& given) { return given.empty(); });
}

// Reports the engine's faults of the members that could be read. Faults of B and C refer to A too.
template <class T>
void report_faults(const Json& value, T& plant, Reader& reader) {
    const auto read = [&](const std::string& name) { return value.contains(name) && reader.clean_at(name); };
    std::vector<Error> faults;
    for (Error& fault : plant_faults(plant)) {
        const std::string below = fault.where.substr(fault.where.find('/') + 1),
                          name = below.substr(0, below.find('/'));
        const bool needs_A = name == "B" || name == "C";
        if (read(name) && (!needs_A || read("A"))) faults.push_back(std::move(fault));
    }
    for (const Error& fault : faults) reader.fault_below(fault.where, 1, fault.message);
}

template <class T>
Description<T>& with_dead_time(Description<T>& description, bool required) {
    return description
        .field("L", &T::L, dead_time(), "Dead time at the plant's input, >= 0; exact everywhere.",
               {.required = required, .unit = "time"})
        .field("uncertainty", &T::uncertainty, uncertainty<T>(description.name()),
               "Ranges of the parameters around their nominal values; robust then holds its limits over all of them.")
        .check_presence(report_faults<T>);
}

const Description<Fopdt>& fopdt() {
    static const auto description = [] {
        Description<Fopdt> d("Fopdt", "First order plus dead time: K e^(-Ls)/(T s + 1).");
        d.tag("type", "fopdt")
            .field("K", &Fopdt::K, gain(), "Static gain, any sign.", {.required = true, .unit = "y/u"})
            .field(
                "T", &Fopdt::T, number(),
                "Time constant; negative: an unstable plant (k/(tau s - 1) is K = -k, T = -tau); 0: a pure dead time.",
                {.required = true, .unit = "time"});
        with_dead_time(d, true).example({{"type", "fopdt"}, {"K", 2}, {"T", 10}, {"L", 3}});
        return d;
    }();
    return description;
}

const Description<Sopdt>& sopdt() {
    static const auto description = [] {
        Description<Sopdt> d("Sopdt", "Second order plus dead time with real lags: K e^(-Ls)/((T1 s + 1)(T2 s + 1)).");
        d.tag("type", "sopdt")
            .field("K", &Sopdt::K, gain(), "Static gain, any sign.", {.required = true, .unit = "y/u"})
            .field("T1", &Sopdt::T1, number(),
                   "First time constant; negative: unstable. (Oscillatory plants: T and zeta instead of T1 and T2.)",
                   {.required = true, .unit = "time"})
            .field("T2", &Sopdt::T2, number(), "Second time constant.", {.required = true, .unit = "time"});
        with_dead_time(d, true).example({{"type", "sopdt"}, {"K", 1.5}, {"T1", 12}, {"T2", 4}, {"L", 2}});
        return d;
    }();
    return description;
}

const Description<OscillatorySopdt>& oscillatory_sopdt() {
    static const auto description = [] {
        Description<OscillatorySopdt> d(
            "OscillatorySopdt", "Second order plus dead time with any damping: K e^(-Ls)/(T^2 s^2 + 2 zeta T s + 1).");
        d.tag("type", "sopdt")
            .field("K", &OscillatorySopdt::K, gain(), "Static gain, any sign.", {.required = true, .unit = "y/u"})
            .field("T", &OscillatorySopdt::T, engine_ruled({.exclusive_minimum = 0}),
                   "1/T is the undamped angular frequency.", {.required = true, .unit = "time"})
            .field("zeta", &OscillatorySopdt::zeta, number(), "Relative damping; below 0 the plant is unstable.",
                   {.required = true});
        with_dead_time(d, true).example({{"type", "sopdt"}, {"K", 1}, {"T", 0.333}, {"zeta", 0.167}, {"L", 0.1}});
        return d;
    }();
    return description;
}

const Description<Ipdt>& ipdt() {
    static const auto description = [] {
        Description<Ipdt> d("Ipdt", "Integrator plus dead time, with an optional lag: K e^(-Ls)/(s (T s + 1)).");
        d.tag("type", "ipdt")
            .field("K", &Ipdt::K, gain(), "Slope of y per unit of u, any sign.",
                   {.required = true, .unit = "y/(u time)"});
        with_dead_time(d, true).field("T", &Ipdt::T, number(), "Lag.", {.unit = "time"});
        d.example({{"type", "ipdt"}, {"K", 0.05}, {"L", 4}});
        return d;
    }();
    return description;
}

const Description<TransferFunction>& transfer_function() {
    static const auto description = [] {
        Description<TransferFunction> d("TransferFunction", "num(s)/den(s) e^(-Ls), proper.");
        d.tag("type", "transfer_function")
            .field("num", &TransferFunction::num, numbers(1, kMaxOrder + 1), "Numerator, descending powers of s.",
                   {.required = true})
            .field("den", &TransferFunction::den, numbers(1, kMaxOrder + 1), "Denominator, descending powers of s.",
                   {.required = true});
        with_dead_time(d, false).example(
            {{"type", "transfer_function"}, {"num", {1}}, {"den", {1, 3, 3, 1}}, {"L", 0.5}});
        return d;
    }();
    return description;
}

// The codec of roots: a number for a real one, [re, im] for a complex one.
Codec<std::vector<std::complex<double>>> roots() {
    using Roots = std::vector<std::complex<double>>;
    return {[](const Json& value, Roots& target, Reader& reader) {
                if (!value.is_array())
                    return reader.fault(wrong_kind(value, "an array of numbers or [re, im] pairs", reader));
                if (value.size() > kMaxOrder) {
                    return reader.fault(reader.name() + " has " + std::to_string(value.size()) + " elements; at most " +
                                        std::to_string(kMaxOrder) + " are accepted.");
                }
                target.clear();
                for (std::size_t i = 0; i < value.size(); ++i) {
                    const Reader::At at(reader, i);
                    if (value[i].is_number()) {
                        target.emplace_back(read_number(value[i], {}, reader).value_or(0), 0);
                    } else if (value[i].is_array() && value[i].size() == 2) {
                        const Reader::At part(reader, std::size_t{0});
                        const double re = read_number(value[i][0], {}, reader).value_or(0);
                        target.emplace_back(re, read_number(value[i][1], {}, reader).value_or(0));
                    } else {
                        reader.fault(wrong_kind(value[i], "a number or a pair [re, im]", reader));
                    }
                }
            },
            [](const Roots& values, Writer& out) {
                out.begin_array();
                for (const auto& root : values) {
                    if (root.imag() == 0) {
                        out.number(root.real());
                        continue;
                    }
                    out.begin_array();
                    out.number(root.real());
                    out.number(root.imag());
                    out.end_array();
                }
                out.end_array();
            },
            [](SchemaBook&) {
                const Json pair{{"type", "array"}, {"items", {{"type", "number"}}}, {"minItems", 2}, {"maxItems", 2}};
                return Json{{"type", "array"},
                            {"maxItems", kMaxOrder},
                            {"items", {{"oneOf", Json::array({Json{{"type", "number"}}, pair})}}}};
            }};
}

const Description<Zpk>& zpk() {
    static const auto description = [] {
        Description<Zpk> d("Zpk", "K prod(s - z)/prod(s - p) e^(-Ls), proper.");
        d.tag("type", "zpk")
            .field("K", &Zpk::K, gain(), "Leading factor; not the static gain.", {.required = true})
            .field("zeros", &Zpk::zeros, roots(), "Zeros: numbers, or [re, im] in conjugate pairs.", {.unit = "1/time"})
            .field("poles", &Zpk::poles, roots(), "Poles: numbers, or [re, im] in conjugate pairs.",
                   {.required = true, .unit = "1/time"});
        with_dead_time(d, false).example({{"type", "zpk"},
                                          {"K", 6},
                                          {"zeros", {-1}},
                                          {"poles", Json::array({-3, Json::array({-1, 2}), Json::array({-1, -2})})},
                                          {"L", 0.2}});
        return d;
    }();
    return description;
}

// Also reads [[1], [0]] for a column and [[1, 0]] for a row, the notation of matrix programs.
void read_vector(const Json& value, std::vector<double>& target, Reader& reader) {
    if (value.is_array() && !value.empty() && value.size() <= kMaxOrder &&
        std::all_of(value.begin(), value.end(), [](const Json& v) { return v.is_array(); })) {
        Json flat = Json::array();
        const bool column = std::all_of(value.begin(), value.end(), [](const Json& v) { return v.size() == 1; });
        if (column || value.size() == 1) {
            for (const Json& row : value) {
                for (const Json& element : row) flat.push_back(element);
            }
            return numbers(1, kMaxOrder).read(flat, target, reader);
        }
    }
    numbers(1, kMaxOrder).read(value, target, reader);
}

Codec<std::vector<double>> vector() {
    Codec<std::vector<double>> codec = numbers(1, kMaxOrder);
    codec.schema = [](SchemaBook&) {
        const Json row{{"type", "array"}, {"items", {{"type", "number"}}}, {"minItems", 1}, {"maxItems", kMaxOrder}};
        return Json{{"type", "array"},
                    {"items", {{"oneOf", Json::array({Json{{"type", "number"}}, row})}}},
                    {"minItems", 1},
                    {"maxItems", kMaxOrder}};
    };
    codec.read = read_vector;
    return codec;
}

Codec<double> direct_term() {
    Codec<double> codec = number();
    codec.read = [](const Json& value, double& target, Reader& reader) {
        const Json* inner = &value;
        while (inner->is_array() && inner->size() == 1) inner = &(*inner)[0];
        if (const auto read = read_number(*inner, {}, reader)) target = *read;
    };
    return codec;
}

const Description<StateSpace>& state_space() {
    static const auto description = [] {
        Description<StateSpace> d("StateSpace", "x' = A x + B u(t - L), y = C x + D u(t - L).");
        d.tag("type", "state_space")
            .field("A", &StateSpace::A, list_of(numbers(1, kMaxOrder), 1, kMaxOrder),
                   "System matrix, n x n, row by row.", {.required = true, .unit = "1/time"})
            .field("B", &StateSpace::B, vector(), "Input column, n numbers.", {.required = true})
            .field("C", &StateSpace::C, vector(), "Output row, n numbers.", {.required = true})
            .field("D", &StateSpace::D, direct_term(), "Direct term.");
        with_dead_time(d, false).example({{"type", "state_space"},
                                          {"A", Json::array({Json::array({-1, 0}), Json::array({1, -2})})},
                                          {"B", {1, 0}},
                                          {"C", {0, 1}}});
        return d;
    }();
    return description;
}

bool has_lags(const Json& value) { return !value.contains("T") && !value.contains("zeta"); }

}  // namespace

const Union<Plant>& plant_contract() {
    static const auto contract = [] {
        Union<Plant> plant(
            "Plant", "A linear plant y = P(s)(u + d) with dead time, in deviations from the operating point.", "type");
        plant.alternative(fopdt())
            .alternative(sopdt(), has_lags)
            .alternative(oscillatory_sopdt())
            .alternative(ipdt())
            .alternative(transfer_function())
            .alternative(zpk())
            .alternative(state_space());
        return plant;
    }();
    return contract;
}

namespace {

constexpr std::size_t kMaxStates = 20, kMaxParameters = 200;
constexpr std::size_t kMaxSymbolLength = 60, kMaxExpressionLength = 10'000;

Json expression_schema() { return {{"type", "string"}, {"maxLength", kMaxExpressionLength}}; }

Json by_name_schema(Json value, std::size_t min, std::size_t max) {
    return {{"type", "object"},
            {"additionalProperties", std::move(value)},
            {"propertyNames", {{"maxLength", kMaxSymbolLength}}},
            {"minProperties", min},
            {"maxProperties", max}};
}

std::string count_fault(const Json& value, std::size_t min, std::size_t max, const Reader& reader) {
    return reader.name() + " has " + std::to_string(value.size()) + " members; it must have " + std::to_string(min) +
           " to " + std::to_string(max) + ".";
}

// The codec of an object whose members have names chosen by the user; `read_member` returns nothing after a fault.
template <class Member, class ReadMember>
auto members_by_name(std::size_t min, std::size_t max, const char* sample, ReadMember read_member) {
    return [=](const Json& value, std::vector<Member>& target, Reader& reader) {
        if (!value.is_object())
            return reader.fault(wrong_kind(value, std::string("an object such as ") + sample, reader));
        if (value.size() < min || value.size() > max) return reader.fault(count_fault(value, min, max, reader));
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
                         "Differential equations in text. Methods use the linearisation around the steady state; "
                         "responses and their figures are those of the nonlinear plant. In expressions: + - * / ^, "
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
                   "Linear plants; the first is nominal: the objective and all figures refer to it.",
                   {.required = true})
            .example({{"type", "set"},
                      {"plants", Json::array({Json{{"type", "fopdt"}, {"K", 2}, {"T", 10}, {"L", 3}},
                                              Json{{"type", "fopdt"}, {"K", 2.5}, {"T", 8}, {"L", 4}}})}});
        return d;
    }();
    return description;
}

// Checks that the arrays of the points match.
void check_points(const Json&, FrequencyResponse& points, Reader& reader) {
    if (const auto fault = points_fault(points)) reader.fault_below(fault->where, 1, fault->message);
}

const Description<FrequencyResponse>& frequency_response() {
    constexpr std::size_t kMinPoints = 8, kMaxPoints = 10'000;
    constexpr int kMaxPoles = 20;
    static const auto description = [] {
        using F = FrequencyResponse;
        Description<F> d("FrequencyResponse",
                         "Measured points of P(j omega). Figures over time are null, and robust maximises Kp/Ti.");
        d.tag("type", "frequency_response")
            .field("omega", &F::omega, numbers(kMinPoints, kMaxPoints),
                   "Angular frequencies, ascending; they must reach beyond the phase crossover.",
                   {.required = true, .unit = "rad/time"})
            .field("re", &F::re, numbers(kMinPoints, kMaxPoints), "Real parts, one per frequency.",
                   {.required = true, .unit = "y/u"})
            .field("im", &F::im, numbers(kMinPoints, kMaxPoints), "Imaginary parts, one per frequency.",
                   {.required = true, .unit = "y/u"})
            .field("unstable_poles", &F::unstable_poles, integer(0, kMaxPoles),
                   "Number of poles in the open right half-plane, which cannot be found from the points.")
            .field("integrators", &F::integrators, integer(0, kMaxPoles), "Number of poles at s = 0.")
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
