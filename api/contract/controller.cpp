#include "api/contract/controller.h"

#include <cmath>

namespace tunewright::api {
namespace {

Codec<FilterType> filter_type() {
    return choice<FilterType>({{"none", FilterType::none},
                               {"derivative", FilterType::derivative},
                               {"measurement_first_order", FilterType::measurement_first_order},
                               {"measurement_second_order", FilterType::measurement_second_order}});
}

// The filter as sent: Tf itself, or N = Td/Tf of a derivative filter.
struct GivenFilter {
    FilterType type = FilterType::none;
    std::optional<double> Tf, N;
};

void check_filter(const Json&, GivenFilter& filter, Reader& reader) {
    if (filter.N && filter.Tf)
        return reader.fault_at("N", "N and Tf are both given; one of them sets the filter (Tf = Td/N). Remove one.");
    if (filter.type == FilterType::none) {
        if (filter.Tf || filter.N) {
            reader.fault(std::string("filter has ") + (filter.Tf ? "Tf" : "N") +
                         " but its type is none; choose derivative, measurement_first_order or "
                         "measurement_second_order, or remove it.");
        }
        return;
    }
    if (filter.N && filter.type != FilterType::derivative) {
        return reader.fault_at("N",
                               "N is given for a measurement filter; N = Td/Tf belongs to type derivative. Give Tf.");
    }
    if (!filter.Tf && !filter.N) {
        reader.fault_at("Tf", std::string("Tf is missing; a filter needs its time constant Tf > 0") +
                                  (filter.type == FilterType::derivative ? ", or N = Td/Tf." : "."));
    }
}

const Description<GivenFilter>& filter_contract() {
    static const auto description = [] {
        Description<GivenFilter> d(
            "Filter",
            "derivative: Td s becomes Td s/(1 + s Tf), acting on c r - y. measurement_first_order: y_f = y/(1 + s Tf). "
            "measurement_second_order: y_f = y/(1 + s Tf + (s Tf)^2/2); these act on y only.");
        d.field("type", &GivenFilter::type, filter_type(), "Kind of filter.")
            .field("Tf", &GivenFilter::Tf, maybe(number({.exclusive_minimum = 0})), "Filter time constant, > 0.",
                   {.unit = "time"})
            .field("N", &GivenFilter::N, maybe(number({.exclusive_minimum = 0})),
                   "Instead of Tf, for type derivative: Tf = Td/N.")
            .check(check_filter);
        return d;
    }();
    return description;
}

double derivative_time(const IdealPid& pid) { return pid.Td; }
double derivative_time(const SeriesPid& pid) { return pid.Td; }
double derivative_time(const Npid& pid) { return pid.Td; }
double derivative_time(const ParallelPid& pid) { return pid.Kp == 0 ? 0 : pid.Kd / pid.Kp; }

bool derivative_acts(const IdealPid& pid) { return pid.Td != 0; }
bool derivative_acts(const SeriesPid& pid) { return pid.Td != 0; }
bool derivative_acts(const Npid& pid) { return pid.Td != 0; }
bool derivative_acts(const ParallelPid& pid) { return pid.Kd != 0; }

template <class Form>
void read_filter(const Json& value, Form& pid, Reader& reader) {
    const std::size_t before = reader.count();
    GivenFilter given;
    filter_contract().read(value, given, reader);
    if (!reader.clean_since(before)) return;
    pid.filter.type = given.type;
    pid.filter.Tf = given.Tf.value_or(0);
    if (!given.N) return;
    pid.filter.Tf = derivative_time(pid) / *given.N;
    if (pid.filter.Tf > 0) return;
    pid.filter = {};
    // Without a derivative there is nothing to filter; any other Td/N is not a valid time constant.
    if (derivative_acts(pid)) reader.fault_at("N", "N gives Tf = Td/N <= 0 here; give Tf > 0 itself.");
}

void write_filter(const Filter& filter, Writer& out) {
    GivenFilter given{filter.type, {}, {}};
    if (filter.type != FilterType::none) given.Tf = filter.Tf;
    filter_contract().write(given, out);
}

template <class Form>
double sign_of(const Form& pid) {
    return pid.Kp;
}
double sign_of(const ParallelPid& pid) { return pid.Kp != 0 ? pid.Kp : pid.Ki != 0 ? pid.Ki : pid.Kd; }

template <class Form>
Description<Form>& with_filter_and_action(Description<Form>& description) {
    return description
        .field(
            "filter", read_filter<Form>, [](const Form& pid, Writer& out) { write_filter(pid.filter, out); },
            [](SchemaBook& book) {
                Json schema = filter_contract().schema(book);
                schema["default"] = {{"type", "none"}};
                return schema;
            },
            "Filter of the derivative or the measurement.")
        .field(
            "action", {}, [](const Form& pid, Writer& out) { out.text(sign_of(pid) < 0 ? "direct" : "reverse"); },
            [](SchemaBook&) {
                return Json{{"type", "string"}, {"enum", {"reverse", "direct"}}};
            },
            "reverse for Kp > 0, direct for Kp < 0. It follows from the sign; in requests it is ignored.",
            {.answer_only = true});
}

// In requests and answers: {"T": 4}.
struct SetpointFilter {
    double T = 0;
};

const Description<SetpointFilter>& setpoint_filter_contract() {
    static const auto description = [] {
        Description<SetpointFilter> d("SetpointFilter", "First-order lag of the set point: r_f = r/(1 + s T).");
        d.field("T", &SetpointFilter::T, number({.exclusive_minimum = 0}), "Its time constant, > 0.",
                {.required = true, .unit = "time"});
        return d;
    }();
    return description;
}

template <class Form>
void add_setpoint_filter(Description<Form>& description) {
    description.field(
        "setpoint_filter",
        [](const Json& value, Form& pid, Reader& reader) {
            if (value.is_null()) return;
            SetpointFilter filter;
            setpoint_filter_contract().read(value, filter, reader);
            pid.setpoint_lag = filter.T;
        },
        [](const Form& pid, Writer& out) { setpoint_filter_contract().write({pid.setpoint_lag}, out); },
        [](SchemaBook& book) { return setpoint_filter_contract().schema(book); },
        "Filter of the set point before the controller; left out: none.", {},
        [](const Form& pid) { return pid.setpoint_lag == 0; });
}

template <class Form>
Description<Form>& with_weights(Description<Form>& description) {
    add_setpoint_filter(description);
    description.field("b", &Form::b, number(), "Set-point weight of the proportional part.")
        .field("c", &Form::c, number(),
               "Set-point weight of the derivative part; different from 0 only with a derivative filter.");
    return with_filter_and_action(description).check([](const Json&, Form& pid, Reader& reader) {
        if (pid.c != 0 && derivative_acts(pid) && pid.filter.type != FilterType::derivative) {
            reader.fault_at("c", "c is " + full_digits(pid.c) +
                                     " and the filter is not derivative: the set-point step would give an infinite "
                                     "kick. Use c = 0 or filter {\"type\": \"derivative\", \"N\": 10}.");
        }
    });
}

NumberRule proportional_rule() {
    return {.not_zero = true, .cure = "For pure integral action use the form parallel with Kp 0 and a Ki."};
}
NumberRule Ti_rule() { return {.exclusive_minimum = 0, .cure = "For no integral action give \"Ti\": null."}; }
const char* kNoIntegral = "No integral action.";

const Description<IdealPid>& ideal() {
    static const auto description = [] {
        Description<IdealPid> d("IdealController",
                                "u = Kp [(b r - y_f) + (1/Ti) int (r - y_f) dt + Td d/dt (c r - y_f)].");
        d.tag("form", "ideal", false)
            .field("Kp", &IdealPid::Kp, number(proportional_rule()),
                   "Proportional gain, with the sign that the plant needs.", {.required = true, .unit = "u/y"})
            .field("Ti", &IdealPid::Ti, number_or_infinite(Ti_rule(), kNoIntegral),
                   "Integral time, > 0; null: no integral action.", {.unit = "time"})
            .field("Td", &IdealPid::Td, number({.minimum = 0}), "Derivative time, >= 0.", {.unit = "time"});
        with_weights(d).example({{"form", "ideal"}, {"Kp", 1.2}, {"Ti", 10}, {"Td", 0}});
        return d;
    }();
    return description;
}

const Description<ParallelPid>& parallel() {
    static const auto description = [] {
        Description<ParallelPid> d("ParallelController",
                                   "Kp + Ki/s + Kd s, weights and filter as in the ideal form; allows Kp = 0.");
        d.tag("form", "parallel")
            .field("Kp", &ParallelPid::Kp, number(), "Proportional gain.", {.unit = "u/y"})
            .field("Ki", &ParallelPid::Ki, number(), "Integral gain.", {.unit = "u/(y time)"})
            .field("Kd", &ParallelPid::Kd, number(), "Derivative gain.", {.unit = "u time/y"});
        with_weights(d).check([](const Json&, ParallelPid& pid, Reader& reader) {
            if (pid.Kp == 0 && pid.Ki == 0 && pid.Kd == 0)
                reader.fault_at("Kp", "Kp, Ki and Kd are all 0; one of them must differ from 0.");
        });
        return d;
    }();
    return description;
}

const Description<SeriesPid>& series() {
    static const auto description = [] {
        Description<SeriesPid> d("SeriesController",
                                 "Kp (1 + 1/(s Ti))(1 + s Td); with a derivative filter (1 + s Td)/(1 + s Tf).");
        d.tag("form", "series")
            .field("Kp", &SeriesPid::Kp, number(proportional_rule()), "Gain of the series form.",
                   {.required = true, .unit = "u/y"})
            .field("Ti", &SeriesPid::Ti, number_or_infinite(Ti_rule(), kNoIntegral),
                   "Integral time, > 0; null: no integral action.", {.required = true, .unit = "time"})
            .field("Td", &SeriesPid::Td, number({.minimum = 0}), "Derivative time, >= 0.", {.unit = "time"});
        with_weights(d).field(
            "b_equivalent", &SeriesPid::b_equivalent, number(),
            "Ti'/Ti: the b of the ideal form that is equivalent to b = 1 in the series form. Only in answers.",
            {.answer_only = true});
        return d;
    }();
    return description;
}

Codec<double> finite_integral_time() {
    Codec<double> codec = number({.exclusive_minimum = 0});
    codec.read = [read = codec.read](const Json& value, double& target, Reader& reader) {
        if (value.is_null())
            return reader.fault(reader.name() +
                                " is null; without integral action the nonlinear form is the form ideal.");
        read(value, target, reader);
    };
    return codec;
}

/// A weight that the nonlinear form fixes.
void fixed_weight(Description<Npid>& description, const char* name, double value, const char* sentence) {
    description.field(
        name,
        [value](const Json& given, Npid&, Reader& reader) {
            double weight = value;
            number().read(given, weight, reader);
            if (weight != value)
                reader.fault(reader.name() + " is " + full_digits(weight) +
                             "; the nonlinear form has b = 1 and c = 0. Leave it out.");
        },
        [value](const Npid&, Writer& out) { out.number(value); },
        [value](SchemaBook&) {
            return Json{{"type", "number"}, {"const", value}};
        },
        sentence);
}

const Description<Npid>& nonlinear() {
    static const auto description = [] {
        Description<Npid> d("NonlinearController",
                            "u = Kp [e + (1/Ti) int exp(-e^2/(2 delta_r^2)) e dt - Td dy/dt], e = r - y: a large error "
                            "has little effect on the integral.");
        d.tag("form", "npid")
            .field("Kp", &Npid::Kp, number({.not_zero = true}),
                   "Proportional gain, with the sign that the plant needs.", {.required = true, .unit = "u/y"})
            .field("Ti", &Npid::Ti, finite_integral_time(), "Integral time, > 0.", {.required = true, .unit = "time"})
            .field("Td", &Npid::Td, number({.minimum = 0}), "Derivative time, >= 0.", {.unit = "time"})
            .field("delta_r", &Npid::delta_r, maybe(number({.exclusive_minimum = 0})),
                   "Size of error at which 61 % of it enters the integral; much larger errors hardly enter. Default: "
                   "the size of evaluate.setpoint_step, also for load steps.",
                   {.unit = "y"});
        fixed_weight(d, "b", 1, "Set-point weight of the proportional part: 1.");
        fixed_weight(d, "c", 0, "Set-point weight of the derivative part: 0.");
        with_filter_and_action(d)
            .check([](const Json&, Npid& pid, Reader& reader) {
                if (pid.filter.type != FilterType::none && pid.filter.type != FilterType::derivative)
                    reader.fault_at("filter",
                                    "filter is a measurement filter, and the nonlinear form allows only none or "
                                    "derivative, because its integral uses the error itself. Choose one of these.");
            })
            .example({{"form", "npid"}, {"Kp", 3.8}, {"Ti", 9.9}, {"Td", 1.4}, {"delta_r", 1}});
        return d;
    }();
    return description;
}

}  // namespace

const Union<Controller>& controller_contract() {
    static const auto contract = [] {
        Union<Controller> controller("Controller", "A PID controller in one of its forms.", "form", "ideal");
        controller.alternative(ideal()).alternative(parallel()).alternative(series()).alternative(nonlinear());
        return controller;
    }();
    return contract;
}

const Description<Equivalents>& equivalents_contract() {
    static const auto description = [] {
        Description<Equivalents> d("Equivalents",
                                   "The same loop in the other forms, exactly; for the form npid its linear part.");
        d.field("parallel", &Equivalents::parallel, answer(parallel()), "Kp + Ki/s + Kd s.")
            .field(
                "series", {},
                [](const Equivalents& value, Writer& out) {
                    value.series ? series().write(*value.series, out) : out.null();
                },
                [](SchemaBook& book) {
                    return Json{{"oneOf", Json::array({series().schema(book), Json{{"type", "null"}}})}};
                },
                "The interacting form; null if it does not exist.")
            .field(
                "why_null", {},
                [](const Equivalents& value, Writer& out) {
                    out.begin_object();
                    out.key("series").text(value.why_no_series.empty()
                                               ? "The series form of this controller does not exist."
                                               : value.why_no_series);
                    out.end_object();
                },
                [](SchemaBook&) {
                    return Json{{"type", "object"}, {"additionalProperties", {{"type", "string"}}}};
                },
                "Reason why there is no series form.", {},
                [](const Equivalents& value) { return value.series.has_value(); });
        return d;
    }();
    return description;
}

}  // namespace tunewright::api
