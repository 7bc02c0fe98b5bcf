// The options of a tuning method: their description (from which decoding, schema, form and docs follow) and their
// values.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "engine/member.h"

namespace tunewright {

enum class OptionType {
    number,
    integer,
    boolean,
    choice,
    object,
    number_or_word,   ///< a number within the limits, or one of `choices`
    text,             ///< any short text, validated by the consumer
    range,            ///< [low, high], both within the limits, low < high
    number_or_range,  ///< either
    complex,          ///< a number, or [re, im]
    list,             ///< elements as `fields.front()` describes them
    numbers_by_name,  ///< an object of numbers under names that the request chooses
};

/// The figure of a design that an option sets or limits.
enum class DesignFigure { none, Mks, Tf, Tf_over_Td, overshoot_percent };

/// The slider of a number.
struct OptionSlider {
    double from = 0, to = 0;  ///< its ends; with `relative`, factors of the value
    bool relative = false, logarithmic = false;
    std::optional<double> step = {};  ///< smallest step; empty: the form's own
    std::string label = {};           ///< empty: the option's name
    std::string low = {}, high = {};  ///< the meaning of its ends, in a word or two
    /// In a group only one option has a slider: the first that is given, else the last whose value is known, if any is.
    std::string group = {};
    std::string moves_with = {};                 ///< another option that moves too, as long as both have the same value
    DesignFigure value_of = DesignFigure::none;  ///< figure of the design that is the option's value if none was given
    DesignFigure reached = DesignFigure::none;   ///< figure of the design that results, perhaps another value
};

using OptionValue = std::variant<bool, double, std::string>;

/// The rule is that of a number, or of each number in the option.
struct OptionDescription : NumberRule {
    std::string name;  ///< e.g. "Ms"
    OptionType type = OptionType::number;
    std::string sentence;   ///< its effect
    std::string unit = {};  ///< "", "time", "u/y", ...
    std::optional<OptionValue> default_value = {};
    std::vector<std::string> choices = {};       ///< words of a choice
    std::vector<OptionDescription> fields = {};  ///< of an object; for a list one element
    int at_most_fields = 0;                      ///< for an object: 0: no limit on the number of fields
    bool required = false;                       ///< for an object's field
    int max = 100;                               ///< for a list the number of elements, for numbers_by_name that of
                                                 ///< names; at least one
    bool main = false;                           ///< a main option: a form shows it at once, the others on request
    std::string in_place_of = {};  ///< another option, which follows from this one: they are not given together
    bool draws = false;            ///< adds data for plots to the report; a page sets it by itself
    std::optional<OptionSlider> slider = {};  ///< of a number that makes sense to be moved
};

/// The limits of a number, and its unit ("time", "u/y", ...).
struct NumberOption {
    std::string_view unit = {};
    std::optional<double> minimum = {}, exclusive_minimum = {}, maximum = {};
    bool required = false;
    std::optional<double> fallback = {};  ///< the number that an empty member stands for, if it is a number
};

/// An option with the default `preset`, unless it is required; without a preset the default is the number's fallback.
OptionDescription described_option(OptionType type, std::string_view name, std::string_view sentence,
                                   const NumberOption& how = {}, std::optional<OptionValue> preset = {});

struct NumberRange {
    double low = 0, high = 0;
};

/// Values by path: "Ms", "filter/Tf", "bounds/Kp/0" (low) and "bounds/Kp/1" (high), "scenarios/1/initial/T". Only the
/// user's values, already checked against the description.
class MethodOptions {
public:
    void set(const std::string& path, OptionValue value) { values_[path] = std::move(value); }
    bool has(const std::string& path) const { return values_.contains(path); }
    std::optional<double> number(const std::string& path) const;
    std::optional<bool> boolean(const std::string& path) const;
    std::optional<std::string> text(const std::string& path) const;
    std::optional<NumberRange> range(const std::string& path) const;
    /// Number of elements of the list at `path`; 0 if it was not given.
    std::size_t size(const std::string& path) const;
    /// Names of the given options directly below `path`, in alphabetical order: fields, or the names of
    /// numbers_by_name.
    std::vector<std::string> names(const std::string& path) const;
    const std::map<std::string, OptionValue>& values() const { return values_; }

private:
    std::map<std::string, OptionValue> values_;
};

/// The option of this name; null if there is none.
const OptionDescription* named(const std::vector<OptionDescription>& options, const std::string& name);

/// The given values, and the defaults of `options` for the others.
MethodOptions with_defaults(const std::vector<OptionDescription>& options, const MethodOptions& given);

/// The fault of the value at `path` ("Ms", "filter/Tf") by its description, as a sentence; empty if there is none.
std::optional<std::string> misfit(const std::vector<OptionDescription>& options, const std::string& path,
                                  const OptionValue& value);

}  // namespace tunewright
