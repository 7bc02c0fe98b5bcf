#include "engine/tuning/method/option_set.h"

#include <algorithm>
#include <stdexcept>

namespace tunewright {

OptionSlider slider_about_value() {
    constexpr double kFactor = 5;
    return {.from = 1 / kFactor, .to = kFactor, .relative = true, .logarithmic = true};
}

OptionSlider slider_within(const OptionDescription& number) {
    const auto low = number.minimum ? number.minimum : number.exclusive_minimum;
    if (!low || !number.maximum) return slider_about_value();
    constexpr double kInside = 0.01;  // of the range: an end that the option may not have
    const double inside = number.exclusive_minimum ? kInside * (*number.maximum - *low) : 0;
    return {.from = *low + inside, .to = *number.maximum};
}

namespace detail {
namespace {

template <class M, class Value>
bool assign(M& member, const std::optional<Value>& value) {
    if (value) member = static_cast<M>(*value);
    return value.has_value();
}

}  // namespace

bool take(const MethodOptions& given, const std::string& path, double& member) {
    return assign(member, given.number(path));
}
bool take(const MethodOptions& given, const std::string& path, int& member) {
    return assign(member, given.number(path));
}
bool take(const MethodOptions& given, const std::string& path, bool& member) {
    return assign(member, given.boolean(path));
}
bool take(const MethodOptions& given, const std::string& path, std::string& member) {
    return assign(member, given.text(path));
}
bool take(const MethodOptions& given, const std::string& path, NumberRange& member) {
    return assign(member, given.range(path));
}

bool take(const MethodOptions& given, const std::string& path, std::variant<double, NumberRange>& member) {
    return assign(member, given.range(path)) || assign(member, given.number(path));
}

bool take(const MethodOptions& given, const std::string& path, std::complex<double>& member) {
    if (assign(member, given.number(path))) return true;
    const auto re = given.number(path + "/0"), im = given.number(path + "/1");
    if (re && im) member = {*re, *im};
    return re && im;
}

bool take(const MethodOptions& given, const std::string& path, std::map<std::string, double>& member) {
    const auto names = given.names(path);
    for (const std::string& name : names) take(given, path + "/" + name, member[name]);
    return !names.empty();
}

}  // namespace detail

OptionDescription& OptionList::described(std::string_view path) {
    std::vector<OptionDescription>* among = &descriptions_;
    for (;;) {
        const std::size_t slash = path.find('/');
        const auto found = std::ranges::find(*among, path.substr(0, slash), &OptionDescription::name);
        if (found == among->end()) throw std::logic_error("no option " + std::string(path) + " is described");
        if (slash == std::string_view::npos) return *found;
        among = &found->fields;
        path.remove_prefix(slash + 1);
    }
}

void OptionList::read(const MethodOptions& given, const std::string& prefix, void* value) const {
    for (const Binding& binding : bindings_)
        binding.read(given, prefix + binding.name, member_at(value, binding.offset));
}

MethodOptions OptionList::given_for(const void* value, const void* other) const {
    MethodOptions given;
    for (const Binding& binding : bindings_)
        binding.write(binding.name, member_at(value, binding.offset), member_at(other, binding.offset), given);
    return given;
}

}  // namespace tunewright
