#include "api/contract/device/given_controller.h"

#include "api/contract/controller.h"
#include "api/contract/product/product.h"

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

Codec<SentController> sent_controller() {
    const auto law = one_of(controller_contract());
    Codec<SentController> codec;
    codec.read = [law](const Json& value, SentController& target, Reader& reader) {
        if (value.is_object() && value.contains("product"))
            object(typed_settings_contract()).read(value, target.typed.emplace(), reader);
        else
            maybe(law).read(value, target.law, reader);
    };
    codec.write = [law](const SentController& sent, Writer& out) {
        if (sent.typed) return typed_settings_contract().write(*sent.typed, out);
        maybe(law).write(sent.law, out);
    };
    codec.schema = [law](SchemaBook& book) {
        return Json{{"oneOf", Json::array({law.schema(book), typed_settings_contract().schema(book)})}};
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
