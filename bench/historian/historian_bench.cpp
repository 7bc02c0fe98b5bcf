// Files of many loops, from lines of text to columns: a day of 50 loops with a row every 10 s, in three layouts.
#include <benchmark/benchmark.h>

#include <array>
#include <cstdio>
#include <string>

#include "api/csv/text.h"
#include "api/historian/loops_reader.h"

namespace tunewright::api {
namespace {

constexpr int kLoops = 50, kRows = 8640, kSeconds = 10;

std::string stamp(int row) {
    std::array<char, 32> text;
    const int seconds = row * kSeconds;
    std::snprintf(text.data(), text.size(), "2026-05-04T%02d:%02d:%02d", seconds / 3600, seconds / 60 % 60,
                  seconds % 60);
    return text.data();
}

std::string value(int row, int loop) {
    return std::to_string(20 + (row * (3 + loop)) % 41) + "." + std::to_string(100 + (row * 7) % 900);
}

std::string tag(int loop) { return "FIC" + std::to_string(100 + loop); }

std::string wide_day() {
    std::string out = "Time";
    for (int loop = 0; loop < kLoops; ++loop) out += "," + tag(loop) + ".PV," + tag(loop) + ".SP," + tag(loop) + ".OP";
    for (int row = 0; row < kRows; ++row) {
        out += "\n" + stamp(row);
        for (int loop = 0; loop < kLoops; ++loop) out += "," + value(row, loop) + ",50," + value(row, loop + 1);
    }
    return out;
}

/// With `parts` a line for each tag, else one for each loop.
std::string long_day(bool parts) {
    std::string out = parts ? "Time,Tag,Value" : "Time,Tag,PV,SP,OP";
    for (int row = 0; row < kRows; ++row)
        for (int loop = 0; loop < kLoops; ++loop) {
            const std::string start = "\n" + stamp(row) + "," + tag(loop), pv = value(row, loop),
                              op = value(row, loop + 1);
            if (parts)
                out += start + ".PV," + pv + start + ".SP,50" + start + ".OP," + op;
            else
                out += start + "," + pv + ",50," + op;
        }
    return out;
}

void read_day(benchmark::State& state, const std::string& text) {
    for (auto _ : state) {
        LoopsReader reader({});
        std::size_t at = 0;
        bool read = true;
        for (int number = 1; const auto line = next_line(text, at); ++number)
            read = read && !reader.line(number, *line);
        read = read && !reader.finish();
        TaggedLoop loop;
        std::size_t rows = 0;
        while (reader.next(loop)) rows += loop.t.size();
        if (!read || rows != std::size_t{kLoops} * kRows) state.SkipWithError("not all rows were read");
    }
    state.SetBytesProcessed(static_cast<std::int64_t>(state.iterations() * text.size()));
    state.counters["rows"] =
        benchmark::Counter(static_cast<double>(state.iterations()) * kLoops * kRows, benchmark::Counter::kIsRate);
}

void wide(benchmark::State& state) { read_day(state, wide_day()); }
BENCHMARK(wide)->Unit(benchmark::kMillisecond);

void line_for_each_loop(benchmark::State& state) { read_day(state, long_day(false)); }
BENCHMARK(line_for_each_loop)->Unit(benchmark::kMillisecond);

void line_for_each_tag(benchmark::State& state) { read_day(state, long_day(true)); }
BENCHMARK(line_for_each_tag)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace tunewright::api

BENCHMARK_MAIN();
