#include "api/contract/record.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "api/csv/columns/loop_mode.h"
#include "api/csv/shape/runs.h"
#include "api/csv/time_stamp.h"
#include "engine/number_text.h"
#include "engine/plant/linear/linear_plant.h"

namespace tunewright::api {
namespace {

constexpr std::size_t kMaxHeadingLength = 200, kMaxModeLength = 40;

Codec<ColumnChoice> column_choice() {
    return {
        [](const Json& value, ColumnChoice& target, Reader& reader) {
            if (value.is_string()) {
                target = value.get<std::string>();
            } else if (value.is_number_integer() && value.get<double>() >= 1 && value.get<double>() <= kMaxColumns) {
                target = value.get<int>();
            } else {
                reader.fault(reader.name() + " is " + shown(value) +
                             "; it must be a heading, or a column's number from 1.");
            }
        },
        [](const ColumnChoice& choice, Writer& out) {
            std::holds_alternative<int>(choice) ? out.integer(std::get<int>(choice))
                                                : out.text(std::get<std::string>(choice));
        },
        [](SchemaBook&) {
            return Json{{"oneOf", Json::array({Json{{"type", "string"}, {"maxLength", kMaxHeadingLength}},
                                               Json{{"type", "integer"}, {"minimum", 1}, {"maximum", kMaxColumns}}})}};
        }};
}

// The codec of two numbers; `example` is for the schema; `check` returns a fault or nothing.
Codec<std::array<double, 2>> two_numbers(std::string example, const char* (*check)(const std::array<double, 2>&)) {
    return {[example, check](const Json& value, std::array<double, 2>& target, Reader& reader) {
                if (!value.is_array() || value.size() != 2)
                    return reader.fault(reader.name() + " is " + shown(value) + "; it must be " + example + ".");
                std::array<double, 2> read{};
                for (std::size_t i = 0; i < read.size(); ++i) {
                    const Reader::At at(reader, i);
                    const auto number = read_number(value[i], {}, reader);
                    if (!number) return;
                    read[i] = *number;
                }
                if (const char* wrong = check(read))
                    return reader.fault(reader.name() + " is " + shown(value) + "; " + wrong);
                target = read;
            },
            [](const std::array<double, 2>& value, Writer& out) {
                out.begin_array();
                for (const double limit : value) out.number(limit);
                out.end_array();
            },
            [](SchemaBook&) {
                return Json{{"type", "array"}, {"items", number_schema({})}, {"minItems", 2}, {"maxItems", 2}};
            }};
}

Codec<std::array<double, 2>> limits() {
    return two_numbers("[low, high], such as [0, 100]", [](const std::array<double, 2>& read) {
        return read[0] < read[1] ? nullptr : "the first number is the lower limit and must be below the second.";
    });
}

}  // namespace

const Description<ColumnChoices>& columns_contract() {
    static const auto description = [] {
        Description<ColumnChoices> d(
            "Columns",
            "Roles of the columns of the csv, by heading or number from 1. Clear headings are found automatically.");
        d.field("t", &ColumnChoices::t, maybe(column_choice()), "Time.")
            .field("u", &ColumnChoices::u, maybe(column_choice()), "Controller output.")
            .field("y", &ColumnChoices::y, maybe(column_choice()), "Measurement.")
            .field("r", &ColumnChoices::r, maybe(column_choice()), "Set point, if the record has one.")
            .field(
                "mode", &ColumnChoices::mode, maybe(column_choice()),
                "Mode of the loop, if the record has it: words such as AUTO, CAS and MAN, or numbers whose meaning the "
                "heading gives, such as Mode (0=MAN, 1=AUTO).")
            .field("d", &ColumnChoices::d,
                   unless<std::vector<ColumnChoice>>(list_of(column_choice(), 1, kMaxFurtherInputs),
                                                     [](const auto& columns) { return columns.empty(); }),
                   "Measured disturbances: further inputs that move y, such as another heater.");
        return d;
    }();
    return description;
}

Codec<std::array<double, 2>> u_step() {
    return two_numbers("[from, to], such as [0, 50]", [](const std::array<double, 2>& read) {
        return read[0] != read[1] ? nullptr : "u must step from one value to another.";
    });
}

Codec<int> run_number() { return integer(1, kMaxFileRuns); }

Codec<std::string> file_time_unit() {
    Codec<std::string> codec = text(20);
    codec.read = [](const Json& value, std::string& target, Reader& reader) {
        if (value.is_string() && seconds_per(value.get_ref<const std::string&>())) {
            target = value.get<std::string>();
            return;
        }
        reader.fault(reader.name() + " is " + shown(value) + "; it must be a unit of time: us, ms, s, min, h or d.");
    };
    return codec;
}

namespace {

void check_record(const Json&, GivenRecord& record, Reader& reader) {
    if (record.u_step && record.u0)
        reader.fault_at("u0", "u0 and u_step are both given; u_step already has the initial u. Remove u0.");
    if (record.from && record.to && *record.to <= *record.from)
        reader.fault_at("to", "to is " + tunewright::text(*record.to) + " and from " + tunewright::text(*record.from) +
                                  "; the part that is used must end after it starts.");
    if (record.csv) {
        for (const auto& [name, given] : {std::pair{"t", record.t.has_value()},
                                          {"u", record.u.has_value()},
                                          {"y", record.y.has_value()},
                                          {"r", record.r.has_value()},
                                          {"mode", record.mode.has_value()},
                                          {"d", record.d.has_value()}}) {
            if (given) reader.fault_at(name, std::string(name) + " is given together with csv; give one of them.");
        }
        return;
    }
    if (record.run) reader.fault_at("run", "run belongs to csv, which is missing.");
    if (record.columns) reader.fault_at("columns", "columns belongs to csv, which is missing.");
    if (record.time_unit) reader.fault_at("time_unit", "time_unit belongs to csv, which is missing.");
    if (record.u && record.u_step) reader.fault_at("u_step", "u_step is for a record without u; remove one of them.");
    const bool has_input = record.u || record.u_step;
    if (!has_input || !record.y) {
        for (const auto& [name, given] : {std::pair{"u", has_input}, {"y", record.y.has_value()}}) {
            if (!given)
                reader.fault_at(
                    name, std::string(name) + " is missing; a record is t (or dt), u and y as arrays, or csv text.");
        }
        return;
    }
    if (record.t && record.dt) reader.fault_at("dt", "dt and t are both given; remove one.");
    if (!record.t && !record.dt)
        reader.fault_at("t", "t is missing; give the times as an array, or the spacing as dt.");
    const auto length = [&](const char* name, const auto& column, const char* values = " numbers") {
        if (column.size() != record.y->size()) {
            reader.fault_at(name, std::string(name) + " has " + std::to_string(column.size()) + values + " and y " +
                                      std::to_string(record.y->size()) + "; they must have the same number.");
        }
    };
    if (record.u) length("u", *record.u);
    if (record.t) length("t", *record.t);
    if (record.r) length("r", *record.r);
    if (record.mode) length("mode", *record.mode, " words");
    for (std::size_t i = 0; record.d && i < record.d->size(); ++i) {
        const Reader::At d(reader, "d"), at(reader, i);
        length("values", (*record.d)[i].values);
        for (std::size_t k = 0; k < i; ++k)
            if ((*record.d)[k].name == (*record.d)[i].name)
                reader.fault_at("name", "name is \"" + (*record.d)[i].name +
                                            "\", which another one has; the names of " +
                                            "measured disturbances must be different.");
    }
}

std::vector<double> times(double dt, std::size_t count) {
    std::vector<double> out(count);
    for (std::size_t i = 0; i < count; ++i) out[i] = static_cast<double>(i) * dt;
    return out;
}

}  // namespace

const Description<Units>& units_contract() {
    constexpr std::size_t kLongest = 40;
    static const auto description = [] {
        Description<Units> d("Units", "Labels, echoed in the result. ISO time stamps are converted to units.time.");
        d.field("time", &Units::time, maybe(text(kLongest)),
                "Unit of every time of the request and the result; s if not given.")
            .field("u", &Units::u, maybe(text(kLongest)), "Unit of the controller output.")
            .field("y", &Units::y, maybe(text(kLongest)), "Unit of the measurement.")
            .check([](const Json&, Units& units, Reader& reader) { reader.set_time_unit(units.time_or_default()); });
        return d;
    }();
    return description;
}

static const Description<FurtherInput>& further_input_contract() {
    static const auto description = [] {
        Description<FurtherInput> d("MeasuredDisturbance", "A further measured input that moves y in addition to u.");
        d.field("name", &FurtherInput::name, text(kMaxHeadingLength), "Its name in the answer.", {.required = true})
            .field("values", &FurtherInput::values, numbers(2, kMaxSamples), "A number for each sample, held like u.",
                   {.required = true});
        return d;
    }();
    return description;
}

const Description<GivenRecord>& record_contract() {
    static const auto description = [] {
        Description<GivenRecord> d("Record",
                                   "A recorded test: t (or dt), u and y as arrays, or csv text. u holds from its "
                                   "sample to the next. r, the set point, is optional.");
        const auto column = [] {
            return maybe(
                numbers(2, kMaxSamples, {.cure = "Thin the record out: a few thousand samples are sufficient."}));
        };
        d.field("t", &GivenRecord::t, column(), "Times, any start, any spacing.", {.unit = "time"})
            .field("dt", &GivenRecord::dt, maybe(number({.exclusive_minimum = 0})), "Spacing, instead of t.",
                   {.unit = "time"})
            .field("u", &GivenRecord::u, column(), "Controller output.", {.unit = "u"})
            .field("y", &GivenRecord::y, column(), "Measurement.", {.unit = "y"})
            .field("r", &GivenRecord::r, column(), "Set point, if the record has one.", {.unit = "y"})
            .field(
                "mode", &GivenRecord::mode, maybe(list_of(text(kMaxModeLength), 2, kMaxSamples)),
                "Mode of the loop in each sample, if the record has it, as text: AUTO, CAS (cascade, which counts as "
                "automatic, with the set point in r), MAN and the words of several makers and languages. An empty "
                "text keeps the mode of the sample before. Samples in manual are left out of today's settings and of "
                "the replay; an unknown word counts as manual, and the warning unknown-mode names it.")
            .field("d", &GivenRecord::d, maybe(list_of(object(further_input_contract()), 1, kMaxFurtherInputs)),
                   "Measured disturbances: further inputs that move y, such as another heater. They are identified "
                   "together with u.")
            .field("csv", &GivenRecord::csv, maybe(text(kMaxCsvLength)),
                   "CSV text instead of the arrays: separated by , ; tab | or blanks, decimal point or comma, times as "
                   "numbers "
                   "or stamps, with or without headings and units. A blank u takes the previous value; a line without "
                   "y still gives u.")
            .field("columns", &GivenRecord::columns, maybe(object(columns_contract())), "Columns of the csv.")
            .field("time_unit", &GivenRecord::time_unit, maybe(file_time_unit()),
                   "Unit of the times in the csv, if the file states none or a wrong one: us, ms, s, min, h, d.")
            .field("kind", &GivenRecord::kind,
                   choice<RecordKind>({{"auto", RecordKind::automatic},
                                       {"step", RecordKind::step},
                                       {"several_steps", RecordKind::several_steps},
                                       {"relay", RecordKind::relay},
                                       {"general", RecordKind::general}}),
                   "Kind of test.")
            .field("u0", &GivenRecord::u0, maybe(number()), "Controller output before the first sample.", {.unit = "u"})
            .field("y0", &GivenRecord::y0, maybe(number()), "Measurement before the first sample.", {.unit = "y"})
            .field("u_limits", &GivenRecord::u_limits, maybe(limits()),
                   "Limits of the actuator, [low, high]: u beyond them did not reach the plant.", {.unit = "u"})
            .field("u_step", &GivenRecord::u_step, maybe(u_step()),
                   "For a record without u: the step of u at its first sample, [from, to]; the member from must then "
                   "leave no sample out.",
                   {.unit = "u"})
            .field("run", &GivenRecord::run, maybe(run_number()),
                   "For a csv whose times start again: the run, from 1. Default: the longest in which y responds to a "
                   "move of u.")
            .field("from", &GivenRecord::from, maybe(number()), "Only samples from this time on are used.",
                   {.unit = "time"})
            .field("to", &GivenRecord::to, maybe(number()), "Only samples up to this time are used.", {.unit = "time"})
            .check(check_record);
        return d;
    }();
    return description;
}

const Description<IdentifyQuestion>& identify_contract() {
    static const auto description = [] {
        Description<IdentifyQuestion> d("Identify", "Identification of the record.");
        d.field("model", &IdentifyOptions::model,
                choice<ModelChoice>({{"auto", ModelChoice::automatic},
                                     {"fopdt", ModelChoice::fopdt},
                                     {"sopdt", ModelChoice::sopdt},
                                     {"sopdt_zero", ModelChoice::sopdt_zero},
                                     {"ipdt", ModelChoice::ipdt},
                                     {"ipdt_lag", ModelChoice::ipdt_lag}}),
                "Structure of the model; auto chooses one and gives the reason.")
            .field("method", &IdentifyOptions::method,
                   choice<IdentifyMethod>({{"auto", IdentifyMethod::automatic},
                                           {"output_error", IdentifyMethod::output_error},
                                           {"relay_fourier", IdentifyMethod::relay_fourier},
                                           {"two_point", IdentifyMethod::two_point}}),
                   "Method of identification.")
            .field("shift", &IdentifyOptions::shift, maybe(number({.exclusive_minimum = 0})),
                   "Shift of the relay test's Fourier integrals.", {.unit = "1/time"})
            .field("traces", &IdentifyQuestion::traces, boolean(),
                   "Return the model's fit and the candidates' y_model too: the record with the free runs, at most "
                   "2,000 points, for a plot.");
        return d;
    }();
    return description;
}

static void read_modes(const std::vector<std::string>& words, ReadRecord& out) {
    ModeColumn mode;
    for (const std::string& word : words) {
        mode.see(word);
        mode.add_row();
    }
    out.unknown_mode = mode.unknown();
    out.record.automatic = mode.take();
}

ReadRecord resolve(GivenRecord given, const Units& units, Reader& reader) {
    ReadRecord out;
    out.record.kind = given.kind;
    out.record.u0 = given.u0;
    out.record.y0 = given.y0;
    out.record.u_limits = given.u_limits;
    if (given.u_step) out.record.u0 = given.u_step->front();
    if (!given.csv) {
        if (!given.u) given.u.emplace(given.y->size(), given.u_step->back());
        if (units.u == "%") out.record.u_full_scale = 100;
        out.record.t = given.t ? std::move(*given.t) : times(*given.dt, given.y->size());
        out.record.u = std::move(*given.u);
        out.record.y = std::move(*given.y);
        if (given.r) out.record.r = std::move(*given.r);
        if (given.mode) read_modes(*given.mode, out);
        if (given.d) out.record.d = std::move(*given.d);
        choose_part(given, out, reader);
        check_disturbances(out.record, false, reader);
        return out;
    }
    CsvOptions options;
    options.columns = given.columns.value_or(ColumnChoices{});
    options.time_unit = units.time_or_default();
    options.file_time_unit = given.time_unit.value_or("");
    options.time_unit_given = units.time.has_value();
    options.dt = given.dt;
    options.u_step = given.u_step;
    options.run = given.run;
    options.unit_u = units.u.value_or("");
    options.unit_y = units.y.value_or("");
    options.max_samples = kMaxSamples;
    auto read = read_csv_record(*given.csv, options);
    if (const auto* faults = std::get_if<std::vector<CsvFault>>(&read)) {
        for (const CsvFault& fault : *faults) reader.fault_below(fault.where, 0, fault.message);
        return out;
    }
    auto& record = std::get<CsvRecord>(read);
    out.record.t = std::move(record.t);
    out.record.u = std::move(record.u);
    out.record.y = std::move(record.y);
    out.record.r = std::move(record.r);
    out.record.automatic = std::move(record.automatic);
    out.record.d = std::move(record.d);
    out.record.line = std::move(record.lines);
    out.record.u_full_scale = record.u_full_scale;
    out.dropped = record.dropped;
    out.unread = std::move(record.unread);
    out.unread_column = std::move(record.unread_column);
    out.unknown_mode = std::move(record.unknown_mode);
    out.time_unit_known = record.time_unit_known;
    out.notes = std::move(record.notes);
    choose_part(given, out, reader);
    check_disturbances(out.record, true, reader);
    return out;
}

namespace {

// Keeps the `rows`, which ascend. A column that the record does not have stays empty.
template <class T>
void keep(const std::vector<std::size_t>& rows, std::vector<T>& column) {
    if (column.empty()) return;
    for (std::size_t k = 0; k < rows.size(); ++k) column[k] = column[rows[k]];
    column.resize(rows.size());
}

// The row whose value of `column` holds at the time `from`; empty if no row before it has a number.
std::optional<std::size_t> row_held(const std::vector<double>& t, const std::vector<double>& column, double from) {
    std::optional<std::size_t> last;
    for (std::size_t i = 0; i < column.size(); ++i)
        if (t[i] < from && !std::isnan(column[i]) && (!last || t[i] >= t[*last])) last = i;
    return last;
}

// u and the disturbances keep their values over blank cells, also from rows that are left out.
void hold_from_before(double from, std::size_t first, Record& record) {
    std::vector<std::vector<double>*> columns = {&record.u};
    for (FurtherInput& input : record.d) columns.push_back(&input.values);
    for (std::vector<double>* column : columns) {
        if (!std::isnan((*column)[first])) continue;
        if (const auto row = row_held(record.t, *column, from)) (*column)[first] = (*column)[*row];
    }
}

// u_step and u0 describe the time before the file's first sample, which `from` leaves out. True if that is reported.
bool left_out_by_from(const GivenRecord& given, const ReadRecord& read, double from, Reader& reader) {
    const auto held = row_held(read.record.t, read.record.u, from);
    if (!held) return false;
    const std::string rows = "the rows before " + tunewright::text(from) + ", which from leaves out";
    if (given.u_step) {
        reader.fault_at(
            "from", "u steps at the first row by u_step, among " + rows + ". Leave from out, or give u as a column.");
        return true;
    }
    const double u = read.record.u[*held];
    if (!given.u0 || *given.u0 == u) return false;
    reader.fault_at("u0", "u0 is " + tunewright::text(*given.u0) + " and u is " + tunewright::text(u) +
                              " at the end of " + rows + ". Leave u0 out.");
    return true;
}

}  // namespace

void choose_part(const GivenRecord& given, ReadRecord& read, Reader& reader) {
    if (!given.from && !given.to) return;
    constexpr double kUnlimited = std::numeric_limits<double>::infinity();
    const double from = given.from.value_or(-kUnlimited), to = given.to.value_or(kUnlimited);
    std::vector<std::size_t> rows;
    for (std::size_t i = 0; i < read.record.t.size(); ++i) {
        if (const double t = read.record.t[i]; t >= from && t <= to) rows.push_back(i);
    }
    if (rows.size() < 2) {
        const auto [first, last] = std::minmax_element(read.record.t.begin(), read.record.t.end());
        const std::string extent = read.record.t.empty() ? ""
                                                         : " It runs from " + tunewright::text(*first) + " to " +
                                                               tunewright::text(*last) + ".";
        reader.fault_at(given.from ? "from" : "to", "fewer than 2 samples of the record are in the part that is used." +
                                                        extent + " Choose a wider part.");
        return;
    }
    if (left_out_by_from(given, read, from, reader)) return;
    Record& record = read.record;
    const auto earliest = std::ranges::min_element(rows, {}, [&](std::size_t row) { return record.t[row]; });
    hold_from_before(from, *earliest, record);
    const std::size_t all = record.t.size();
    keep(rows, record.t);
    keep(rows, record.u);
    keep(rows, record.y);
    keep(rows, record.r);
    keep(rows, record.automatic);
    for (FurtherInput& input : record.d) keep(rows, input.values);
    keep(rows, record.line);
    read.notes.push_back("The record has " + std::to_string(all) + " samples; the " + std::to_string(rows.size()) +
                         " from " + tunewright::text(record.t.front()) + " to " + tunewright::text(record.t.back()) +
                         " were used, as asked.");
}

namespace {

/// True if `d` is a + b x within rounding, with b other than 0, in the rows where both have numbers; NaN repeats the
/// number before it.
bool moves_as(const std::vector<double>& d, const std::vector<double>& x) {
    constexpr double kValueTolerance = 1e-9;  // of the range of d
    std::vector<std::pair<double, double>> held;
    double last_d = std::nan(""), last_x = last_d;
    for (std::size_t i = 0; i < d.size(); ++i) {
        if (!std::isnan(d[i])) last_d = d[i];
        if (!std::isnan(x[i])) last_x = x[i];
        if (!std::isnan(last_d) && !std::isnan(last_x)) held.emplace_back(last_x, last_d);
    }
    if (held.empty()) return false;
    const auto [x0, d0] = held.front();
    const auto by = [&](auto member) {
        return std::ranges::max_element(
            held, {}, [&, first = held.front().*member](const auto& row) { return std::abs(row.*member - first); });
    };
    const auto farthest = by(&std::pair<double, double>::first);
    const double range_x = farthest->first - x0,
                 range_d = std::abs(by(&std::pair<double, double>::second)->second - d0);
    if (range_x == 0 || range_d == 0) return false;
    const double slope = (farthest->second - d0) / range_x;
    return std::ranges::all_of(held, [&, x0 = x0, d0 = d0](const auto& row) {
        return std::abs(row.second - d0 - slope * (row.first - x0)) <= kValueTolerance * range_d;
    });
}

/// "u", "y" or the name of an earlier disturbance that is an affine function of number `k`; "" if there is none.
std::string twin_of(const Record& record, std::size_t k) {
    const std::vector<double>& d = record.d[k].values;
    if (moves_as(d, record.u)) return "u";
    if (moves_as(d, record.y)) return "y";
    for (std::size_t i = 0; i < k; ++i)
        if (moves_as(d, record.d[i].values)) return "\"" + record.d[i].name + "\"";
    return "";
}

}  // namespace

void check_disturbances(const Record& record, bool from_csv, Reader& reader) {
    if (record.d.empty()) return;
    for (std::size_t k = 0; k < record.d.size(); ++k) {
        if (record.d[k].values.size() != record.u.size() || record.y.size() != record.u.size()) return;
        const std::string twin = twin_of(record, k);
        if (twin.empty()) continue;
        reader.fault_below((from_csv ? "columns/d/" : "d/") + std::to_string(k), 0,
                           "\"" + record.d[k].name + "\" moves as " + twin +
                               " does in every row, so their effects on y cannot be separated. Leave it out.");
    }
}

namespace {

/// Asks for the unit if the times are in assumed seconds and the plant takes more than a day (the times may be
/// milliseconds) or less than a thousandth of a second (they may be days).
void ask_for_unit(IdentifiedModel& model) {
    constexpr double kDay = 86400, kShort = 1e-3;
    const auto plant = LinearPlant::make(model.plant);
    if (!plant) return;
    const double total = plant->time_scale();
    const bool slow = total > kDay;
    if (!slow && !(total > 0 && total < kShort)) return;
    model.warnings.insert(
        model.warnings.begin(),
        {"time-unit-doubtful",
         (slow ? "The identified plant is slower than a day: its lags and dead time add up to " +
                     tunewright::text(total / kDay, 3) + " days"
               : "The identified plant is faster than a millisecond: its lags and dead time add up to " +
                     tunewright::text(total, 3) + " s") +
             ", because the times were assumed to be seconds; the file does not name their unit. If they are " +
             (slow ? "milliseconds, choose ms" : "days, the unit of spreadsheets, choose d") +
             " as the unit of the times."});
}

}  // namespace

std::optional<Warning> mode_warning(const ReadRecord& read) {
    if (read.unknown_mode.empty()) return std::nullopt;
    return Warning{"unknown-mode", read.unknown_mode};
}

namespace {

std::string dropped_sentence(const ReadRecord& read) {
    return std::to_string(read.dropped) +
           " line(s) of the csv that cannot be read, or without a time, or with neither u nor y, were left out.";
}

}  // namespace

std::vector<std::string> reading_faults(const ReadRecord& read) {
    std::vector<std::string> out;
    if (!read.unread.empty()) out.push_back(read.unread);
    if (!read.unread_column.empty()) out.push_back(read.unread_column);
    if (const auto warning = mode_warning(read)) out.push_back(warning->detail);
    if (read.dropped > 0) out.push_back(dropped_sentence(read));
    return out;
}

void add_reading(const ReadRecord& read, IdentifiedModel& model) {
    DataQuality& quality = model.data_quality;
    quality.time_unit_assumed = !read.time_unit_known;
    if (!read.time_unit_known) ask_for_unit(model);
    if (!read.unread.empty()) model.warnings.push_back({"lines-left-out", read.unread});
    if (!read.unread_column.empty()) model.warnings.push_back({"column-left-out", read.unread_column});
    if (auto warning = mode_warning(read)) model.warnings.push_back(*std::move(warning));
    quality.samples_dropped += read.dropped;
    quality.notes.insert(quality.notes.begin(), read.notes.begin(), read.notes.end());
    if (read.dropped > 0) quality.notes.push_back(dropped_sentence(read));
}

void leave_out_traces(const IdentifyQuestion& question, IdentifiedModel& model) {
    if (question.traces) return;
    model.fit = {};
    for (Candidate& candidate : model.candidates) candidate.y_model.clear();
}

}  // namespace tunewright::api
