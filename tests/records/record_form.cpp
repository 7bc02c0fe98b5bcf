#include "tests/records/record_form.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include "api/csv/csv_record.h"

namespace tunewright::records {
namespace {

using Cells = std::vector<std::string>;

std::string digits(double value, int figures) {
    char text[40];
    std::snprintf(text, sizeof text, "%.*g", figures, value);
    return std::isnan(value) ? "" : text;
}

Cells headings(const Record& record) {
    Cells cells = {"t [s]", "u", "y"};
    if (!record.r.empty()) cells.emplace_back("r");
    for (const FurtherInput& input : record.d) cells.push_back(input.name);
    return cells;
}

/// A run's rows, with a constant set point if the test has one and the run has none.
void add_rows(const Record& run, const Record& test, std::vector<Cells>& rows) {
    for (std::size_t i = 0; i < run.t.size(); ++i) {
        Cells cells = {digits(run.t[i], 10), digits(run.u[i], 7), digits(run.y[i], 7)};
        if (!test.r.empty()) cells.push_back(digits(run.r.empty() ? test.r.front() : run.r[i], 7));
        for (const FurtherInput& input : run.d) cells.push_back(digits(input.values[i], 7));
        rows.push_back(std::move(cells));
    }
}

void shift(Record& run, double by) {
    for (double& t : run.t) t += by;
}

void several_runs(const MadeRecord& made, Record test, std::vector<Cells>& rows, Random& random) {
    const int n = static_cast<int>(test.t.size()), at = n / 10 + random.below(n - n / 10);
    const double dt = (test.t.back() - test.t.front()) / (n - 1);
    const int kind = random.below(4);
    if (kind == 2) {  // the clock is set back, once
        for (std::size_t i = static_cast<std::size_t>(at); i < test.t.size(); ++i) test.t[i] -= dt * (1 + at % 8);
        return add_rows(test, test, rows);
    }
    if (kind == 3) {  // a buffer writes adjacent rows in reverse order
        add_rows(test, test, rows);
        for (int k = 1 + random.below(4); k > 0; --k) {
            const auto i = static_cast<std::ptrdiff_t>(random.below(n - 1));
            std::iter_swap(rows.begin() + i, rows.begin() + i + 1);
        }
        return;
    }
    Record earlier = made.earlier;
    shift(earlier, -earlier.t.front());
    shift(test, -test.t.front());
    add_rows(earlier, test, rows);
    if (random.chance(0.4)) rows.push_back(headings(test));
    add_rows(test, test, rows);
    if (kind == 1) {  // the logger continues in steady state
        Record still = test;
        still.d.clear();
        const auto left = static_cast<std::size_t>(10 + random.below(n));
        for (auto* column : {&still.t, &still.u, &still.y}) column->resize(std::min(column->size(), left));
        std::fill(still.u.begin(), still.u.end(), test.u.back());
        std::fill(still.y.begin(), still.y.end(), test.y.back());
        if (!still.r.empty()) still.r.assign(still.t.size(), test.r.back());
        add_rows(still, test, rows);
    }
}

void countdown(const MadeRecord& made, Record test, std::vector<Cells>& rows, Random& random) {
    if (random.chance(0.5)) {
        const double end = test.t.back();
        for (double& t : test.t) t = end - t;
        return add_rows(test, test, rows);
    }
    Record rest = made.earlier;
    const double dt = rest.t[1] - rest.t[0], end = rest.t.back() + dt;
    for (double& t : rest.t) t = end - t;
    shift(test, -test.t.front());
    add_rows(rest, test, rows);
    add_rows(test, test, rows);
}

std::string line_of(const Cells& cells) {
    std::string line;
    for (const std::string& cell : cells) line += (line.empty() ? "" : ",") + cell;
    return line;
}

/// One line, damaged in one of the usual ways; "" instead of its line end if the next line follows on it.
std::string damaged(Cells cells, Random& random) {
    static const char* const kWords[] = {"ERR", "40.0degC", "#REF!", "OVERRUN", "4O.2", "\xEF\xBF\xBD"};
    std::string& cell = cells[static_cast<std::size_t>(random.chance(0.5) ? 2 : random.below(3))];
    switch (random.below(5)) {
        case 0: cell = kWords[random.below(6)]; break;
        case 1:
        case 2: cell = cell.substr(0, static_cast<std::size_t>(1 + random.below(3))); break;
        case 3: {
            const std::string line = line_of(cells);
            return line.substr(0, static_cast<std::size_t>(1 + random.below(static_cast<int>(line.size()))));
        }
        default: cell.insert(cell.size() / 2, ".."); break;
    }
    return line_of(cells);
}

}  // namespace

const char* name_of(Form form) {
    static constexpr const char* kNames[] = {"columns", "several runs", "countdown", "damaged cells", "two inputs"};
    return kNames[static_cast<int>(form)];
}

Record earlier_run(const MadeRecord& made, ActuatedPlant& process, double dt, int settling, double size,
                   Random& random) {
    const bool rests = made.form == Form::countdown;
    const int rows = rests ? 4 + random.below(30) : std::max(12, static_cast<int>(settling * random.uniform(0.1, 1)));
    Record record;
    double u = 0;
    for (int row = 0; row < rows; ++row) {
        if (!rests && (row == rows / 8 || random.chance(1.5 / settling))) u = random.uniform(-1, 1);
        record.t.push_back(dt * row);
        record.u.push_back(u);
        record.y.push_back(on_grid(process.y() + size * made.noise_std * random.normal(), size * made.plant.grid));
        for (int k = 0; k < kFine; ++k) process.advance(u, 0);
    }
    const double pause = rests ? 0 : settling * random.spread(0.05, 3);
    for (int k = static_cast<int>(kFine * pause); k > 0; --k) process.advance(0, 0);
    return record;
}

FurtherInput second_input(const MadeRecord& made, double dt, double size, std::vector<double>& on_y, Random& random) {
    TruePlant plant;
    plant.K = size * random.spread(0.15, 1.5) * (random.chance(0.5) ? -1 : 1);
    plant.lags = {made.plant.lag_sum() * random.spread(0.3, 2)};
    if (random.chance(0.3)) plant.lags.push_back(plant.lags[0] * random.uniform(0.1, 0.5));
    plant.L = random.chance(0.3) ? 0 : made.plant.lag_sum() * random.spread(0.05, 1);
    plant.integrating = made.plant.integrating;
    if (plant.integrating) plant.K /= made.plant.L + made.plant.lag_sum();
    const double often =
        random.chance(0.3) ? random.uniform(0.02, 0.2) : random.uniform(1, 6) / static_cast<double>(on_y.size());
    FurtherInput input{"Q2", {}};
    RunningPlant running(plant, dt);
    double level = 0, y = 0;
    for (double& added : on_y) {
        if (random.chance(often)) level = random.uniform(-1, 1);
        added += y;
        y = running.advance(level, 0);
        input.values.push_back(level);
    }
    return input;
}

std::string written(const MadeRecord& made) {
    Random random(made.seed + 77'000'017);
    std::vector<Cells> rows;
    if (made.form == Form::several_runs)
        several_runs(made, made.record, rows, random);
    else if (made.form == Form::countdown)
        countdown(made, made.record, rows, random);
    else
        add_rows(made.record, made.record, rows);
    const double rate = made.form == Form::damaged_cells ? random.spread(0.002, 0.015) : 0;
    std::string text = line_of(headings(made.record)) + "\n";
    for (const Cells& cells : rows) {
        if (rate > 0 && random.chance(rate)) {
            text += random.chance(0.1) ? line_of(cells) : damaged(cells, random) + "\n";
            continue;
        }
        text += line_of(cells) + "\n";
    }
    return text;
}

std::variant<Record, std::string> read_back(const MadeRecord& made, const std::string& csv) {
    api::CsvOptions options;
    for (const FurtherInput& input : made.record.d) options.columns.d.emplace_back(input.name);
    auto read = api::read_csv_record(csv, options);
    if (const auto* faults = std::get_if<std::vector<api::CsvFault>>(&read)) return faults->front().message;
    auto& from = std::get<api::CsvRecord>(read);
    Record record;
    record.t = std::move(from.t), record.u = std::move(from.u), record.y = std::move(from.y);
    record.r = std::move(from.r), record.d = std::move(from.d), record.line = std::move(from.lines);
    return record;
}

Judgement judge_as_sent(MadeRecord made) {
    if (made.form == Form::columns) return judge(made);
    auto read = read_back(made, written(made));
    if (const auto* sentence = std::get_if<std::string>(&read)) {
        Judgement j;
        j.refused = true;
        j.refusal = "not read: " + *sentence;
        return j;
    }
    made.record = std::get<Record>(std::move(read));
    return judge(made);
}

}  // namespace tunewright::records
