#include "api/contract/plant/plant.h"

#include <algorithm>

#include "engine/plant/linear/factor.h"

namespace tunewright::api {
namespace {

constexpr std::size_t kMaxOrder = 50;

// What numbers must keep (plant_rules.h), as the schema shows it.
Codec<double> gain() { return engine_ruled({.not_zero = true}); }
Codec<double> dead_time() { return engine_ruled({.minimum = 0}); }

using Range = std::optional<FactorRange>;

// [low, high] around 1.
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

// Only the parameters that the plant type has.
template <class T>
const Description<Uncertainty>& uncertainty_contract(const std::string& type) {
    static const auto description = [&] {
        Description<Uncertainty> d(type + "Uncertainty",
                                   "Factors [low, high] of nominal values, low <= 1 <= high: limits hold on the "
                                   "corners, the centre and the worst point found inside.");
        d.field("K", &Uncertainty::K, factors(), "Of the plant's gain.");
        if constexpr (requires(T plant) { plant.T; }) d.field("T", &Uncertainty::T, factors(), "Of T.");
        if constexpr (requires(T plant) { plant.T1; }) {
            d.field("T1", &Uncertainty::T1, factors(), "Of T1.");
            d.field("T2", &Uncertainty::T2, factors(), "Of T2.");
        }
        d.field("L", &Uncertainty::L, factors(), "Of the dead time.");
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

// What the engine says of the members that could be read. Of B and C it speaks beside A.
template <class T>
void report_faults(const Json& value, T& plant, Reader& reader) {
    const auto read = [&](const std::string& name) { return value.contains(name) && reader.clean_at(name); };
    std::vector<Error> faults;
    for (Error& fault : plant_faults(plant)) {
        const std::string below = fault.where.substr(fault.where.find('/') + 1),
                          name = below.substr(0, below.find('/'));
        const bool beside_A = name == "B" || name == "C";
        if (read(name) && (!beside_A || read("A"))) faults.push_back(std::move(fault));
    }
    for (const Error& fault : faults) reader.fault_below(fault.where, 1, fault.message);
}

template <class T>
Description<T>& with_dead_time(Description<T>& description, bool required) {
    return description
        .field("L", &T::L, dead_time(), "Dead time at the plant's input, >= 0; exact everywhere.",
               {.required = required, .unit = "time"})
        .field("uncertainty", &T::uncertainty, uncertainty<T>(description.name()),
               "How far parameters may lie from their nominal values; robust then holds its limits everywhere.")
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

// A number for a real one, [re, im] for a complex one.
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
            .field("K", &Zpk::K, gain(), "Factor in front; not the static gain.", {.required = true})
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

// Also [[1], [0]] for a column and [[1, 0]] for a row, as matrix programs write them.
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

}  // namespace tunewright::api
