#include "engine/tuning/method/option_list.h"

#include <algorithm>
#include <stdexcept>

namespace tunewright {

void OptionList::read(const MethodOptions& given, const std::string& prefix, void* value) const {
    for (const Binding& binding : bindings_)
        binding.read(given, prefix + binding.name, static_cast<char*>(value) + binding.offset);
}

MethodOptions OptionList::given_for(const void* value, const void* other) const {
    MethodOptions given;
    for (const Binding& binding : bindings_)
        if (binding.write)
            binding.write(binding.name, static_cast<const char*>(value) + binding.offset,
                          static_cast<const char*>(other) + binding.offset, given);
    return given;
}

OptionSlider slider_about_value() {
    constexpr double kFactor = 5;
    return {.from = 1 / kFactor, .to = kFactor, .relative = true, .logarithmic = true};
}

OptionSlider slider_within(const OptionDescription& number) {
    const auto low = number.minimum ? number.minimum : number.exclusive_minimum;
    if (!low || !number.maximum) return slider_about_value();
    constexpr double kInside = 0.01;  // of the range: distance from an excluded limit
    const double inside = number.exclusive_minimum ? kInside * (*number.maximum - *low) : 0;
    return {.from = *low + inside, .to = *number.maximum};
}

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

OptionDescription& OptionList::describe(OptionType type, std::string_view name, std::string_view sentence,
                                        const NumberOption& how) {
    OptionDescription& option = descriptions_.emplace_back();
    option.name = name;
    option.type = type;
    option.sentence = sentence;
    option.unit = how.unit;
    option.minimum = how.minimum;
    option.exclusive_minimum = how.exclusive_minimum;
    option.maximum = how.maximum;
    option.required = how.required;
    return option;
}

void OptionList::describe_number(OptionType type, std::string_view name, std::string_view sentence,
                                 const NumberOption& how, std::optional<double> preset) {
    OptionDescription& option = describe(type, name, sentence, how);
    if (preset && !how.required)
        option.default_value = *preset;
    else if (how.fallback)
        option.default_value = *how.fallback;
}

void OptionList::describe_list(std::string_view name, std::string_view sentence, OptionDescription element, int max) {
    OptionDescription& option = describe(OptionType::list, name, sentence);
    option.fields = {std::move(element)};
    option.max = max;
}

void OptionList::describe_as(const std::vector<OptionDescription>& others) {
    descriptions_.insert(descriptions_.end(), others.begin(), others.end());
}

void OptionList::add(Binding binding) { bindings_.push_back(std::move(binding)); }

void OptionList::number_or_word(const Member<std::optional<double>>& member, std::string_view name,
                                std::string_view sentence, std::string_view word, const NumberOption& how) {
    OptionDescription& option = describe(OptionType::number_or_word, name, sentence, how);
    option.choices = {std::string(word)};
    if (member.preset) option.default_value = *member.preset;
    add({std::string(name), member.offset,
         [](const MethodOptions& given, const std::string& path, void* number) {
             if (given.has(path)) *static_cast<std::optional<double>*>(number) = given.number(path);
         },
         [word = std::string(word)](const std::string& own, const void* value, const void* other,
                                    MethodOptions& given) {
             const auto& number = *static_cast<const std::optional<double>*>(value);
             if (number == *static_cast<const std::optional<double>*>(other)) return;
             given.set(own, number ? OptionValue(*number) : OptionValue(word));
         }});
}

void OptionList::number_or_range(const Member<std::optional<std::variant<double, NumberRange>>>& member,
                                 std::string_view name, std::string_view sentence, const NumberOption& how) {
    using Value = std::variant<double, NumberRange>;
    describe(OptionType::number_or_range, name, sentence, how);
    bind<std::optional<Value>>(member.offset, name,
                               [](const MethodOptions& given, const std::string& path) -> std::optional<Value> {
                                   if (const auto range = given.range(path)) return Value(*range);
                                   if (const auto number = given.number(path)) return Value(*number);
                                   return std::nullopt;
                               });
}

void OptionList::numbers_by_name(const Member<std::map<std::string, double>>& member, std::string_view name,
                                 std::string_view sentence) {
    describe(OptionType::numbers_by_name, name, sentence);
    bind<std::map<std::string, double>>(member.offset, name, [](const MethodOptions& given, const std::string& path) {
        std::map<std::string, double> numbers;
        const std::string below = path + "/";
        for (const std::string& own : given.names(path)) numbers[own] = given.number(below + own).value_or(0);
        return std::optional(std::move(numbers));
    });
}

void OptionList::complex_list(const Member<std::vector<std::complex<double>>>& member, std::string_view name,
                              std::string_view sentence, OptionDescription element, int max) {
    element.type = OptionType::complex;
    describe_list(name, sentence, std::move(element), max);
    bind_list<std::complex<double>>(member.offset, name, [](const MethodOptions& given, const std::string& path) {
        if (const auto real = given.number(path)) return std::complex<double>(*real);
        return std::complex<double>(given.number(path + "/0").value_or(0), given.number(path + "/1").value_or(0));
    });
}

void OptionList::text_list(const Member<std::vector<std::string>>& member, std::string_view name,
                           std::string_view sentence, OptionDescription element, int max) {
    element.type = OptionType::text;
    describe_list(name, sentence, std::move(element), max);
    bind_list<std::string>(member.offset, name, [](const MethodOptions& given, const std::string& path) {
        return given.text(path).value_or("");
    });
}

}  // namespace tunewright
