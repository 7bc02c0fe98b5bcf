// records FIRST COUNT [--show KIND] [--family N] [--test N] [--noise N] [--form N] [--stride N] [--file]: made records
// from seeds FIRST on, each or every N-th, judged, and the table of what came out. KIND: silent, unstable, above,
// refused, uncovered, all. --form: 0 to 4, as columns, several runs, countdown, damaged cells, two inputs; --file
// prints the first one's file and ends.
#include <algorithm>
#include <atomic>
#include <cstdio>
#include <cstring>
#include <map>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "tests/records/record_form.h"

namespace tunewright::records {
namespace {

struct Options {
    std::uint64_t first = 1;
    int count = 720, stride = 1;
    std::string show;
    int family = -1, test = -1, noise = -1;
    Form form = Form::columns;
    bool file = false;
};

struct Row {
    std::uint64_t seed = 0;
    MadeRecord made;
    Judgement judgement;
};

bool above(const Judgement& j) { return j.designed && j.Ms_true && *j.Ms_true > 1.25 * j.Ms_asked; }
bool unstable(const Judgement& j) { return j.designed && !j.Ms_true; }

/// Counts of one line of the table.
struct Line {
    int records = 0, refused = 0, silent = 0, designed = 0, above = 0, unstable = 0, comparable = 0, covered = 0;
    std::vector<double> K_error, response_error, response_ratio, IAE_ratio, width;

    void add(const Judgement& j) {
        ++records;
        refused += j.refused;
        if (j.refused) return;
        silent += j.wrong_in_silence();
        designed += j.designed;
        above += records::above(j) && !j.warned_badly;
        unstable += records::unstable(j) && !j.warned_badly;
        if (j.comparable) {
            ++comparable;
            covered += j.covered();
            K_error.push_back(j.K_error());
            if (const auto ratio = j.width()) width.push_back(*ratio);
        }
        if (!j.designed) return;
        if (j.IAE_ratio) IAE_ratio.push_back(*j.IAE_ratio);
        response_error.push_back(j.response_error);
        if (j.response_std > 0) response_ratio.push_back(j.response_error / j.response_std);
    }
};

double quantile(std::vector<double> values, double share) {
    if (values.empty()) return 0;
    const auto at = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), at, values.end());
    return *at;
}

void print(const std::string& name, const Line& line) {
    const double percent = 100.0 / std::max(1, line.records), of_designs = 100.0 / std::max(1, line.designed);
    std::printf("%-22s %6d %7.1f %7.2f %9.2f %9.2f %8.1f %8.2f %8.2f %8.2f %8.2f %8.2f %8.2f %8.2f %8.2f\n",
                name.c_str(), line.records, line.refused * percent, line.silent * percent, line.above * of_designs,
                line.unstable * of_designs, 100.0 * line.covered / std::max(1, line.comparable),
                100 * quantile(line.K_error, 0.5), 100 * quantile(line.K_error, 0.95),
                100 * quantile(line.response_error, 0.95), quantile(line.response_ratio, 0.95),
                quantile(line.IAE_ratio, 0.5), quantile(line.IAE_ratio, 0.95), quantile(line.width, 0.5),
                quantile(line.width, 0.95));
}

bool shown(const std::string& kind, const Judgement& j) {
    if (kind == "silent") return j.wrong_in_silence();
    if (kind == "unstable") return unstable(j) && !j.warned_badly;
    if (kind == "above") return (above(j) || unstable(j)) && !j.warned_badly;
    if (kind == "refused") return j.refused;
    if (kind == "uncovered") return !j.refused && j.comparable && !j.covered();
    return kind == "all";
}

void show(const Row& row) {
    const Judgement& j = row.judgement;
    std::printf("\nseed %llu: %s\n   K %.4g +- %.2g (true %.4g), Ms %s, response off %.2g (stated %.2g)\n   %s\n",
                static_cast<unsigned long long>(row.seed), row.made.text().c_str(), j.K, j.K_std, j.K_true,
                j.Ms_true ? std::to_string(*j.Ms_true).c_str() : "unstable", j.response_error, j.response_std,
                (j.refused ? j.refusal : j.detail).c_str());
}

Options parse(int argc, char** argv) {
    Options options;
    int place = 0;
    for (int i = 1; i < argc; ++i) {
        const std::string word = argv[i];
        if (word == "--show" && i + 1 < argc)
            options.show = argv[++i];
        else if (word == "--family" && i + 1 < argc)
            options.family = std::atoi(argv[++i]);
        else if (word == "--test" && i + 1 < argc)
            options.test = std::atoi(argv[++i]);
        else if (word == "--noise" && i + 1 < argc)
            options.noise = std::atoi(argv[++i]);
        else if (word == "--form" && i + 1 < argc)
            options.form = static_cast<Form>(std::clamp(std::atoi(argv[++i]), 0, kForms - 1));
        else if (word == "--stride" && i + 1 < argc)
            options.stride = std::max(1, std::atoi(argv[++i]));
        else if (word == "--file")
            options.file = true;
        else if (place++ == 0)
            options.first = std::strtoull(word.c_str(), nullptr, 10);
        else
            options.count = std::atoi(word.c_str());
    }
    return options;
}

bool wanted(const Options& options, const MadeRecord& made) {
    return (options.family < 0 || static_cast<int>(made.plant.family) == options.family) &&
           (options.test < 0 || static_cast<int>(made.test) == options.test) &&
           (options.noise < 0 || static_cast<int>(made.noise) == options.noise);
}

int run(const Options& options) {
    if (options.file) {
        std::fputs(written(make_record(options.first, options.form)).c_str(), stdout);
        return 0;
    }
    std::vector<std::optional<Row>> rows(static_cast<std::size_t>(options.count));
    std::atomic<int> next = 0;
    const auto work = [&] {
        for (int i = next++; i < options.count; i = next++) {
            const std::uint64_t seed =
                options.first + static_cast<std::uint64_t>(i) * static_cast<std::uint64_t>(options.stride);
            MadeRecord made = make_record(seed, options.form);
            if (!wanted(options, made)) continue;
            Judgement judgement = judge_as_sent(made);
            rows[static_cast<std::size_t>(i)] = Row{seed, std::move(made), std::move(judgement)};
        }
    };
    std::vector<std::thread> threads;
    for (unsigned k = 0; k < std::max(1u, std::thread::hardware_concurrency()); ++k) threads.emplace_back(work);
    for (std::thread& thread : threads) thread.join();

    std::map<int, Line> by[3];
    Line all;
    std::map<std::string, int> codes;
    for (const auto& row : rows) {
        if (!row) continue;
        all.add(row->judgement);
        by[0][static_cast<int>(row->made.plant.family)].add(row->judgement);
        by[1][static_cast<int>(row->made.test)].add(row->judgement);
        by[2][static_cast<int>(row->made.noise)].add(row->judgement);
        std::vector<std::string> reported = row->judgement.codes;
        std::sort(reported.begin(), reported.end());
        reported.erase(std::unique(reported.begin(), reported.end()), reported.end());
        for (const std::string& code : reported) ++codes[code];
        if (!options.show.empty() && shown(options.show, row->judgement)) show(*row);
    }
    std::printf("\n%-22s %6s %7s %7s %9s %9s %8s %8s %8s %8s %8s %8s %8s %8s %8s\n", "% of records", "number",
                "refused", "silent", "Ms > 1.25", "unstable", "covered", "K median", "K 95 %", "G 95 %", "G/std 95",
                "IAE", "IAE 95 %", "width", "width 95");
    for (const auto& [family, line] : by[0]) print(name_of(static_cast<Family>(family)), line);
    for (const auto& [test, line] : by[1]) print(name_of(static_cast<Test>(test)), line);
    for (const auto& [noise, line] : by[2]) print(name_of(static_cast<Noise>(noise)), line);
    print(options.form == Form::columns ? "all" : name_of(options.form), all);
    std::printf("\nwarnings, of %d records:", all.records);
    for (const auto& [code, count] : codes) std::printf(" %s %d", code.c_str(), count);
    std::printf("\n");
    return 0;
}

}  // namespace
}  // namespace tunewright::records

int main(int argc, char** argv) { return tunewright::records::run(tunewright::records::parse(argc, argv)); }
