// Conversions between the ideal form and what is typed into a product (catalogue.h), exact both ways.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/controller/product/product.h"
#include "engine/expected.h"

namespace tunewright::product {

/// Ranges of measurement and output in the user's units; low < high.
struct Spans {
    double y_low = 0, y_high = 100;
    double u_low = 0, u_high = 100;
};

/// What a formula may need beside the law.
struct Context {
    Spans spans = {};
    bool y_span_given = false, u_span_given = false;  ///< a formula that needs one that is not given is an error
    std::optional<double> sample_time_s = {};         ///< > 0
    /// The period with which a loop of fixed clock really runs, where the caller knows it better than the firmware's
    /// name does; empty: the firmware's.
    std::optional<double> loop_clock_s = {};
    double seconds_per_time = 1;  ///< controllers' times are in the caller's unit, the blocks' in their own

    static Context with_spans(const Spans& spans, std::optional<double> sample_time_s = {}) {
        return {.spans = spans, .y_span_given = true, .u_span_given = true, .sample_time_s = sample_time_s};
    }
};

/// A remark that travels with a conversion.
struct Note {
    std::string code;    ///< kebab-case, stable
    std::string detail;  ///< a sentence with the figures

    bool operator==(const Note&) const = default;
};

/// Says what of the design the product cannot be, or what has to be done beside it; other notes say how the settings
/// were computed, and what to know about that. By the code alone.
bool tells_deviation(const Note& note);

struct Converted {
    Settings settings = {};  ///< in full precision
    std::vector<Note> notes = {};
    IdealPid realised = {};  ///< what the block does with them as typed: filter and weights included
};

/// What to type for a law. Errors: not_representable, with the nearest in words, for what the block cannot be (with
/// `nearest` it is converted and noted); invalid_argument for a missing span ("y_span", "u_span") or sample time
/// ("sample_time").
Expected<Converted> to_settings(const Product& product, const IdealPid& pid, const Context& context, bool nearest);

struct RowSettings {
    double at = 0;
    Converted converted = {};  ///< notes: of this row alone
};

struct ConvertedSchedule {
    std::vector<RowSettings> rows = {};
    std::vector<Note> notes = {};  ///< of the schedule, then those that every row would have
};

/// Each row as `to_settings` converts it. Notes of the schedule: `no-gain-scheduling` where none of the product is
/// known, `too-many-rows` where it holds fewer sets, `interpolation` where it goes otherwise from one to the next.
/// Errors: those of a row, at "rows/K" where it is the row that the product cannot be.
Expected<ConvertedSchedule> to_settings(const Product& product, const Schedule& schedule, const Context& context,
                                        bool nearest);

/// Rounded to each parameter's resolution and range; floating-point numbers stay as they are.
Settings as_typed(const Product& product, const Settings& settings);

/// One value as a person types it: by the parameter's resolution, a floating-point number with four digits and at least
/// two decimals ("1.50", "0.008333").
std::string typed_text(const Product& product, const Setting& setting);

/// The law as the block computes it at the sample time Ts (in the caller's unit). Rules that nobody published are
/// backward differences; the firmware's clock is Ts. For settings that to_controller takes; of others every gain is 0.
SampledPid sampled_law(const Product& product, const Settings& settings, const Context& context, double Ts);

std::optional<double> default_sample_time_s(const Product& product);

/// Tf in seconds of a filter that is compiled into the firmware, as it is published; empty: it can be set, or there is
/// none.
std::optional<double> compiled_filter_time(const Product& product, const Context& context);

/// A numeric parameter that a search may vary: `to_controller` of the varied settings is what it designs with.
struct Tunable {
    std::string name;
    ParameterRole role = ParameterRole::gain;  ///< gain, integral, derivative or filter
    Range range = {};
    double resolution = 0;  ///< 0: none
};
std::vector<Tunable> tunable_parameters(const Product& product);

}  // namespace tunewright::product
