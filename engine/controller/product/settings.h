// Conversions between the ideal form and the settings of a product (catalogue.h), exact both ways.
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

/// The inputs of a formula other than the law.
struct Context {
    Spans spans = {};
    bool y_span_given = false, u_span_given = false;  ///< false: a formula that needs the span is an error
    std::optional<double> sample_time_s = {};         ///< > 0
    /// The real period of a loop with a fixed clock, if the caller knows it; empty: the firmware's nominal period.
    std::optional<double> loop_clock_s = {};
    double seconds_per_time = 1;  ///< seconds in the caller's time unit; the blocks have their own units

    static Context with_spans(const Spans& spans, std::optional<double> sample_time_s = {}) {
        return {.spans = spans, .y_span_given = true, .u_span_given = true, .sample_time_s = sample_time_s};
    }
};

/// A note that belongs to a conversion.
struct Note {
    std::string code;    ///< kebab-case, stable
    std::string detail;  ///< a sentence with the figures

    bool operator==(const Note&) const = default;
};

/// True if the note names a part of the design that the product cannot implement, or something to do in addition; other
/// notes say how the settings were computed. Decided by the code alone.
bool is_deviation(const Note& note);

struct Converted {
    Settings settings = {};  ///< in full precision
    std::vector<Note> notes = {};
    IdealPid realised = {};  ///< the law of the block with the settings as typed, filter and weights included
};

/// The settings for a law. Errors: not_representable, with the nearest settings in words, if the block cannot represent
/// it (with `nearest` it is converted and noted); invalid_argument for a missing span ("y_span", "u_span") or sample
/// time ("sample_time").
Expected<Converted> to_settings(const Product& product, const IdealPid& pid, const Context& context, bool nearest);

struct RowSettings {
    double at = 0;
    Converted converted = {};  ///< notes: those of this row only
};

struct ConvertedSchedule {
    std::vector<RowSettings> rows = {};
    std::vector<Note> notes = {};  ///< notes on the schedule, then those that every row has
};

/// Each row as `to_settings` converts it. Notes of the schedule: `no-gain-scheduling` if the product's is unknown,
/// `too-many-rows` if it has fewer sets, `interpolation` if it interpolates differently. Errors: those of a row, at
/// "rows/K" if the product cannot represent the row.
Expected<ConvertedSchedule> to_settings(const Product& product, const Schedule& schedule, const Context& context,
                                        bool nearest);

/// Rounded to each parameter's resolution and range; floating-point numbers stay as they are.
Settings as_typed(const Product& product, const Settings& settings);

/// One value as a person enters it: by the parameter's resolution, a floating-point number with four digits and at
/// least two decimals ("1.50", "0.008333").
std::string typed_text(const Product& product, const Setting& setting);

/// The law as the block computes it at the sample time Ts (in the caller's unit). Unpublished rules are backward
/// differences; the firmware's clock is Ts. Only for settings that to_controller accepts; otherwise every gain is 0.
SampledPid sampled_law(const Product& product, const Settings& settings, const Context& context, double Ts);

std::optional<double> default_sample_time_s(const Product& product);

/// Tf in seconds of a filter that is compiled into the published firmware; empty: it can be set, or there is none.
std::optional<double> compiled_filter_time(const Product& product, const Context& context);

/// A numeric parameter that a search may vary: `to_controller` of the varied settings gives the controller to evaluate.
struct Tunable {
    std::string name;
    ParameterRole role = ParameterRole::gain;  ///< gain, integral, derivative or filter
    Range range = {};
    double resolution = 0;  ///< 0: none
};
std::vector<Tunable> tunable_parameters(const Product& product);

}  // namespace tunewright::product
