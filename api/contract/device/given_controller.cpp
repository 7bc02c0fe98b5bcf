#include "api/contract/device/given_controller.h"

#include "api/contract/controller.h"
#include "api/contract/device/typed_controller.h"
#include "api/contract/plant/typed.h"
#include "api/contract/product/product.h"
#include "api/csv/time_stamp.h"
#include "engine/plant/typed/words.h"

namespace tunewright::api {
namespace {

const Description<TypedSettings>& typed_settings_contract() {
    static const auto description = [] {
        using T = TypedSettings;
        Description<T> d("TypedSettings", "Settings as typed into a product.");
        d.field("product", &T::product, text(kMaxProductIdLength), "Id of the product.", {.required = true})
            .field("settings", &T::settings, settings_codec(), "Its parameters by name, as typed.", {.required = true})
            .field("y_span", &T::y_span, maybe(numbers(2, 2)),
                   "Low and high end of the measurement's range; default: those of implement.", {.unit = "y"})
            .field("u_span", &T::u_span, maybe(numbers(2, 2)),
                   "Low and high end of the output's range; default: those of implement.", {.unit = "u"})
            .field("sample_time", &T::sample_time, maybe(number({.exclusive_minimum = 0})),
                   "Period of the controller; default: that of implement.", {.unit = "time"})
            .check([](const Json&, T& given, Reader& reader) {
                check_span("y_span", given.y_span, reader);
                check_span("u_span", given.u_span, reader);
            });
        return d;
    }();
    return description;
}

std::optional<GivenController> typed(const TypedSettings& sent, const std::optional<GivenDevice>& implement,
                                     const std::string& time_label, Reader& reader) {
    const auto device = device_of(sent.device(implement), time_label, reader);
    if (!device) return std::nullopt;
    const std::size_t before = reader.count();
    check_needs(*device, reader);
    if (!reader.clean_since(before)) return std::nullopt;
    auto given = typed_controller(*device, sent.settings);
    if (given) return std::move(*given);
    reader.fault_below(given.error().where, 0, given.error().message);
    return std::nullopt;
}

}  // namespace

GivenDevice TypedSettings::device(const std::optional<GivenDevice>& others) const {
    GivenDevice on_device;
    on_device.product = product;
    const GivenDevice other = others.value_or(GivenDevice{});
    on_device.y_span = y_span ? y_span : other.y_span;
    on_device.u_span = u_span ? u_span : other.u_span;
    on_device.sample_time = sample_time ? sample_time : other.sample_time;
    return on_device;
}

namespace {

// The times of the text are in s, and those of the request must be too: a plant next to it may have no units.
void read_text(const std::string& text, SentController& target, Reader& reader) {
    if (seconds_per(reader.time_unit()) != 1)
        return reader.fault("the controller is a text, whose times are in s, but units.time is " +
                            shown(Json(reader.time_unit())) +
                            ". Give the form ideal with times in that unit, or product and settings.");
    auto typed = read_controller(text);
    if (!typed) return reader.fault(as_sentence(typed.error().message));
    TypedSettings& settings = target.typed.emplace();
    settings.product = std::move(typed->product);
    settings.settings = std::move(typed->settings);
}

Json text_schema(SchemaBook& book) {
    Json schema{{"type", "string"}, {"title", "TypedController"}, {"maxLength", typed::kMaxLength}};
    schema["description"] =
        "A controller as control software writes it, with times in s: the call of a product's constructor, or a "
        "transfer function of PID form.";
    schema["examples"] = {"pidstd(1.5, 120, 20, 10)", "pid(1.5, 0.0125, 30, 2)",
                          "LimPID(k=1.5, Ti=120, Td=20, Nd=10, wp=0.6)", "1.5 + 0.0125/s + 30*s/(2*s + 1)"};
    book.components["TypedController"] = std::move(schema);
    return {{"$ref", "#/components/schemas/TypedController"}};
}

}  // namespace

Codec<SentController> sent_controller() {
    const auto law = one_of(controller_contract());
    Codec<SentController> codec;
    codec.read = [law](const Json& value, SentController& target, Reader& reader) {
        if (value.is_string())
            read_text(value.get_ref<const std::string&>(), target, reader);
        else if (value.is_object() && value.contains("product"))
            object(typed_settings_contract()).read(value, target.typed.emplace(), reader);
        else
            maybe(law).read(value, target.law, reader);
    };
    codec.write = [law](const SentController& sent, Writer& out) {
        if (sent.typed) return typed_settings_contract().write(*sent.typed, out);
        maybe(law).write(sent.law, out);
    };
    codec.schema = [law](SchemaBook& book) {
        return Json{
            {"oneOf", Json::array({law.schema(book), typed_settings_contract().schema(book), text_schema(book)})}};
    };
    return codec;
}

void resolve(SentController& sent, const std::optional<GivenDevice>& implement, const std::string& time_label,
             Reader& reader) {
    if (sent.typed)
        sent.given = typed(*sent.typed, implement, time_label, reader);
    else if (sent.law)
        sent.given.emplace(*sent.law);
}

}  // namespace tunewright::api
