#include "api/contract/range/range_request.h"

namespace tunewright::api {
namespace {

constexpr double kTfOverTd = 0.1;  // of a row without a Tf

const Description<RobustFilterOptions>& range_filter_contract() {
    static const auto description = [] {
        using F = RobustFilterOptions;
        Description<F> d("RangeFilter", "The measurement filter of every row, one of the two.");
        d.field("Tf", &F::Tf, maybe(number({.exclusive_minimum = 0})), "Its time constant, fixed.", {.unit = "time"})
            .field("Tf_over_Td", &F::Tf_over_Td, maybe(number({.exclusive_minimum = 0, .maximum = 10})),
                   "Its time constant as a part of Td.")
            .check([](const Json&, F& filter, Reader& reader) {
                if (filter.Tf && filter.Tf_over_Td)
                    reader.fault_at("Tf_over_Td", "Tf and Tf_over_Td are both given; remove one.");
            });
        return d;
    }();
    return description;
}

void check_rows(const Json&, ScheduleWish& wish, Reader& reader) {
    if (wish.controller == ControllerKind::PI && wish.filter.Tf_over_Td) {
        const Reader::At at(reader, "filter");
        reader.fault_at("Tf_over_Td", "Tf_over_Td belongs to a PID; a PI has no Td. Give Tf, or leave the filter out.");
    }
    if (!wish.given) return;
    const Reader::At list(reader, "given");
    check_given_rows(*wish.given, reader);
}

}  // namespace

const Description<GivenRow>& given_row_contract() {
    static const auto description = [] {
        Description<GivenRow> d("GivenRow", "A row of a schedule, in the ideal form.");
        d.field("at", &GivenRow::at, number(), "Its place.", {.required = true})
            .field("Kp", &GivenRow::Kp, number({.not_zero = true}), "Gain.", {.required = true, .unit = "u/y"})
            .field("Ti", &GivenRow::Ti, number({.exclusive_minimum = 0}), "Integral time.",
                   {.required = true, .unit = "time"})
            .field("Td", &GivenRow::Td, number({.minimum = 0}), "Derivative time.", {.unit = "time"})
            .field("Tf", &GivenRow::Tf, maybe(number({.minimum = 0})),
                   "Time constant of the second-order measurement filter; 0.1 Td if not given.", {.unit = "time"})
            .field("b", &GivenRow::b, number({.minimum = 0, .maximum = 1}), "Set-point weight.");
        return d;
    }();
    return description;
}

void check_given_rows(const std::vector<GivenRow>& rows, Reader& reader) {
    for (std::size_t k = 1; k < rows.size(); ++k) {
        const Reader::At row(reader, k);
        if (!(rows[k].at > rows[k - 1].at))
            reader.fault_at("at", "at is " + shown(rows[k].at) + " after " + shown(rows[k - 1].at) +
                                      "; the rows must ascend, each place once. Sort them.");
        if (rows[k].Kp * rows[0].Kp < 0)
            reader.fault_at("Kp", "Kp is " + shown(rows[k].Kp) + " and that of the first row " + shown(rows[0].Kp) +
                                      "; all rows must have one sign, for between them Kp would pass 0.");
    }
}

Codec<Interpolation> interpolation_word() {
    using enum Interpolation;
    std::vector<std::pair<std::string, Interpolation>> words;
    for (const auto interpolation : {steps, linear_in_gains, linear_in_times})
        words.emplace_back(to_string(interpolation), interpolation);
    return choice<Interpolation>(std::move(words));
}

const Description<ScheduleWish>& schedule_wish_contract() {
    static const auto description = [] {
        using W = ScheduleWish;
        const NumberRule limit{.exclusive_minimum = 1, .maximum = 4};
        Description<W> d("ScheduleWish", "Limits, and how the user's controller moves between its rows.");
        d.field("controller", &W::controller,
                choice<ControllerKind>({{"PID", ControllerKind::PID}, {"PI", ControllerKind::PI}}), "Its kind.")
            .field("Ms", &W::Ms, number(limit), "Limit on Ms everywhere in the range.")
            .field("Mt", &W::Mt, number(limit), "Limit on Mt everywhere in the range.")
            .field("filter", &W::filter, object(range_filter_contract()),
                   "The measurement filter; without one as the method robust has it, by one rule for all rows.",
                   {.no_default = true})
            .field("aim", &W::aim, choice<range::Aim>({{"worst", range::Aim::worst}, {"mean", range::Aim::mean}}),
                   "Of one setting: the least worst or mean IAE over each point's own optimum.")
            .field("allowance", &W::allowance, number({.exclusive_minimum = 0, .maximum = 1}),
                   "By which part the schedule's IAE may lie above that of each place's own optimum.")
            .field("rows", &W::rows, maybe(integer(1, range::kMostRows)), "Number of rows; the fewest if not given.")
            .field("interpolation", &W::interpolation, interpolation_word(),
                   "Between rows: steps with hysteresis; Kp, 1/Ti, Td linear; Kp, Ti, Td linear.")
            .field("hysteresis", &W::hysteresis, number({.minimum = 0, .maximum = 0.2}),
                   "Of steps, as a part of the range.")
            .field("between", &W::between,
                   choice<range::Between>({{"parameters", range::Between::parameters},
                                           {"frequency_response", range::Between::frequency_response}}),
                   "The plants between points: logarithms of the parameters, or frequency responses for plants of "
                   "unlike structure.")
            .field("b", &W::b, number({.minimum = 0, .maximum = 1}), "Set-point weight of every row.")
            .field("given", &W::given, maybe(list_of(object(given_row_contract()), 1, range::kMostRows)),
                   "A schedule to judge: nothing is designed then.")
            .check(check_rows);
        return d;
    }();
    return description;
}

range::RangeOptions options_of(const ScheduleWish& wish) {
    range::RangeOptions options;
    options.controller = wish.controller;
    options.limits.Ms = wish.Ms;
    options.limits.Mt = wish.Mt;
    options.filter = wish.filter;
    options.aim = wish.aim;
    options.b = wish.b;
    options.allowance = wish.allowance;
    options.rows = wish.rows;
    options.interpolation = wish.interpolation;
    options.hysteresis = wish.hysteresis;
    options.between = wish.between;
    return options;
}

std::vector<ScheduleRow> rows_of(const std::vector<GivenRow>& given) {
    std::vector<ScheduleRow> rows;
    for (const GivenRow& row : given)
        rows.push_back({.at = row.at,
                        .Kp = row.Kp,
                        .Ti = row.Ti,
                        .Td = row.Td,
                        .Tf = row.Tf.value_or(kTfOverTd * row.Td),
                        .b = row.b});
    return rows;
}

std::vector<ScheduleRow> rows_of(const ScheduleWish& wish) {
    return wish.given ? rows_of(*wish.given) : std::vector<ScheduleRow>{};
}

}  // namespace tunewright::api
