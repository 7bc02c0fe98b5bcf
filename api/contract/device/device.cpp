#include "api/contract/device/device.h"

#include "api/contract/product/meant_product.h"
#include "api/contract/product/product.h"
#include "api/contract/result/evaluation.h"
#include "api/csv/time_stamp.h"
#include "engine/controller/product/catalogue.h"

namespace tunewright::api {
namespace {

// The rules of the program are not allowed with a product.
void check_rules(const Json& value, GivenDevice& given, Reader& reader) {
    check_span("y_span", given.y_span, reader);
    check_span("u_span", given.u_span, reader);
    if (!given.product && !given.sample_time)
        reader.fault(
            "implement names neither a product nor a sample_time; give the product's id (GET /v1/controllers "
            "lists them), or the sample_time of a program.");
    if (!given.product) return;
    for (const char* name : {"integral", "derivative", "algorithm"})
        if (value.contains(name))
            reader.fault_at(name, std::string(name) + " is fixed by the product; leave it out, or leave out product.");
}

}  // namespace

const Description<GivenDevice>& implement_contract() {
    static const auto description = [] {
        using G = GivenDevice;
        Description<G> d(
            "Implement",
            "The implemented controller: a product with the spans of its signals, or a sampled program of the ideal "
            "form. Entries are converted to it and evaluated on it; the method robust designs for it.");
        d.field("product", &G::product, maybe(text(kMaxProductIdLength)), "Id of a product of GET /v1/controllers.")
            .field("y_span", &G::y_span, maybe(numbers(2, 2)), "Low and high end of the measurement's range.",
                   {.unit = "y"})
            .field("u_span", &G::u_span, maybe(numbers(2, 2)), "Low and high end of the output's range.", {.unit = "u"})
            .field("sample_time", &G::sample_time, maybe(number({.exclusive_minimum = 0})),
                   "Period of the controller. Default: that of the product if it is known; otherwise the controller "
                   "counts as continuous.",
                   {.unit = "time"})
            .field("integral", &G::integral,
                   maybe(choice<IntegralRule>({{"backward", IntegralRule::backward},
                                               {"forward", IntegralRule::forward},
                                               {"trapezoidal", IntegralRule::trapezoidal}})),
                   "Rule of the integral; without a product. Default: backward.")
            .field("derivative", &G::derivative,
                   maybe(choice<G::Derivative>(
                       {{"backward", G::Derivative::difference}, {"filtered", G::Derivative::filtered}})),
                   "backward: the difference of two samples, without a filter of the derivative; filtered: with the "
                   "controller's derivative filter, by backward Euler. Default: filtered if the controller has such a "
                   "filter. Without a product.")
            .field("algorithm", &G::velocity, maybe(choice<bool>({{"position", false}, {"velocity", true}})),
                   "velocity: the program adds increments; the same output as position within limits. Default: "
                   "position. Without a product.")
            .field("computation_delay", &G::computation_delay, number({.minimum = 0}),
                   "Time from a sample to its output.", {.unit = "time"})
            .field("u_resolution", &G::u_resolution, number({.minimum = 0}),
                   "The output is rounded to multiples of this value in the responses; 0: no rounding.", {.unit = "u"})
            .field("y_resolution", &G::y_resolution, number({.minimum = 0}),
                   "The measurement is rounded to multiples of this value in the responses; 0: no rounding.",
                   {.unit = "y"})
            .field("dead_band", &G::dead_band, number({.minimum = 0}),
                   "Dead band: a smaller error counts as 0 in the responses; 0: no dead band.", {.unit = "y"})
            .check(check_rules)
            .example({{"product", "emerson_deltav_series"},
                      {"y_span", {0, 200}},
                      {"u_span", {0, 100}},
                      {"sample_time", 0.5}});
        return d;
    }();
    return description;
}

namespace {

// Null if the id is unknown; the reader then has the fault.
const product::Product* product_of(const std::string& id, Reader& reader) {
    if (const auto* product = product::find(id)) return product;
    const std::string meant = meant_product(id);
    reader.fault_at("product", "product is \"" + id +
                                   "\", which is not in the catalogue; GET /v1/controllers lists it." +
                                   (meant.empty() ? "" : " " + meant));
    return nullptr;
}

DerivativeRule rule_of(GivenDevice::Derivative given) {
    return given == GivenDevice::Derivative::difference ? DerivativeRule::difference
                                                        : DerivativeRule::filtered_backward;
}

}  // namespace

std::optional<device::DeviceModel> device_of(const GivenDevice& given, const std::string& time_label, Reader& reader) {
    device::DeviceModel device;
    if (given.product) {
        device.product = product_of(*given.product, reader);
        if (device.product == nullptr) return std::nullopt;
        const auto seconds = seconds_per(time_label);
        if (!seconds) return std::nullopt;  // reported when the units of the request were resolved
        device.context = context_of(given.y_span, given.u_span, *seconds);
        product::Context& context = device.context;
        auto period = product::default_sample_time_s(*device.product);
        if (given.sample_time) period = context.loop_clock_s = *given.sample_time * *seconds;
        context.sample_time_s = period;
        device.Ts = period ? *period / *seconds : 0;
    } else {
        device.Ts = given.sample_time.value_or(0);
        device.integral = given.integral.value_or(IntegralRule::backward);
        if (given.derivative) device.derivative = rule_of(*given.derivative);
        device.velocity = given.velocity.value_or(false);
    }
    device.computation_delay = given.computation_delay;
    device.program = {{}, given.u_resolution, given.y_resolution, given.dead_band};
    return device;
}

void check_needs(const device::DeviceModel& device, Reader& reader) {
    if (device.product == nullptr) return;
    // The needs of the formulas do not depend on the settings: any will do.
    const auto any = product::to_settings(*device.product, IdealPid{.Kp = 1, .Ti = 10}, device.context, true);
    if (!any && any.error().kind == ErrorKind::invalid_argument)
        reader.fault_at(any.error().where, any.error().message);
}

namespace {

const Description<DeviceEntry>& difference_contract() {
    static const auto description = [] {
        Description<DeviceEntry> d("Difference", "Difference of the implemented loop from the entry's ideal one.");
        d.field("Ms_percent", &DeviceEntry::Ms_percent, figure(), "Difference of Ms.", {.unit = "%"})
            .field("load_IAE_percent", &DeviceEntry::load_IAE_percent, figure(), "Difference of the load IAE.",
                   {.unit = "%"})
            .field("overshoot_points", &DeviceEntry::overshoot_points, figure(),
                   "Difference of the overshoot of a set-point step, in percent of the step.", {.unit = "%"})
            .field("differs", &DeviceEntry::differs,
                   only_answered(list_of(choice<DifferingFigure>({{"Ms", DifferingFigure::Ms},
                                                                  {"load_IAE", DifferingFigure::load_IAE},
                                                                  {"overshoot", DifferingFigure::overshoot}}))),
                   "Figures that differ by more than 2 %. Empty for an unstable loop.")
            .why_null("Unknown for this loop.");
        return d;
    }();
    return description;
}

// A member of the implemented loop, next to its difference in the answer.
template <class M>
void loop_field(Description<DeviceEntry>& d, const char* name, M DeviceLoop::*member, const Codec<M>& codec,
                const char* sentence) {
    d.field(
        name, {},
        [member, codec](const DeviceEntry& on_device, Writer& out) { codec.write(on_device.loop.*member, out); },
        codec.schema, sentence, {},
        codec.skip ? Callable<bool(const DeviceEntry&)>(
                         [member, codec](const DeviceEntry& on_device) { return codec.skip(on_device.loop.*member); })
                   : Callable<bool(const DeviceEntry&)>());
}

}  // namespace

const Description<DeviceEntry>& implemented_contract() {
    static const auto description = [] {
        Description<DeviceEntry> d(
            "Implemented",
            "The loop with the settings as typed, with the controller's own algorithm: Ms, Mt and the margins are "
            "those of the sampled loop, indices and traces those of the continuous y.");
        d.field(
            "sample_time", {},
            [](const DeviceEntry& on_device, Writer& out) {
                on_device.fitted.law.Ts > 0 ? out.number(on_device.fitted.law.Ts) : out.null();
            },
            [](SchemaBook&) {
                return Json{{"type", {"number", "null"}}};
            },
            "Period of the controller; null: it counts as continuous.", {.unit = "time"});
        loop_field(d, "robustness", &DeviceLoop::robustness, object(robustness_contract()), "Peaks and margins.");
        loop_field(d, "performance", &DeviceLoop::performance, object(performance_contract()),
                   "Figures of the responses.");
        loop_field(d, "responses", &DeviceLoop::responses, maybe(answer(responses_contract())),
                   "Traces over time; left out with points 0 and for unstable loops.");
        loop_field(d, "region", &DeviceLoop::region, maybe(answer(region_contract())),
                   "Figures over all plants for which the controller is designed; left out if there is only one.");
        d.field(
            "difference", {},
            [](const DeviceEntry& on_device, Writer& out) { difference_contract().write(on_device, out); },
            [](SchemaBook& book) { return difference_contract().schema(book); },
            "Difference from the ideal loop of this entry.");
        return d;
    }();
    return description;
}

}  // namespace tunewright::api
