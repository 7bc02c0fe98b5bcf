#include "engine/identification/record/data_quality.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <string>

#include "engine/identification/record/record_kind.h"
#include "engine/identification/record/series.h"
#include "engine/number_text.h"
#include "engine/numerics/statistics.h"

namespace tunewright {
namespace {

void describe_sampling(const CleanRecord& r, DataQuality& quality) {
    std::vector<double> spacings = tunewright::spacings(r);
    constexpr double kMaxOddShare = 0.01;  // of the spacings: an occasional missed row of a logger
    const double typical = median(spacings);
    const auto odd = std::count_if(spacings.begin(), spacings.end(),
                                   [&](double d) { return std::abs(d - typical) > kOffSpacing * typical; });
    quality.sample_time = typical * r.scale.t_scale;
    quality.irregular = static_cast<double>(odd) > kMaxOddShare * static_cast<double>(spacings.size());
    if (quality.irregular)
        quality.notes.emplace_back("The samples are not evenly spaced; each is used at its own time.");

    // Loggers that write on change often have long spacings: only rare ones are gaps.
    constexpr double kMinUsualSpacings = 5, kUsualQuantile = 0.95;
    const auto usual =
        spacings.begin() + static_cast<std::ptrdiff_t>(kUsualQuantile * static_cast<double>(spacings.size() - 1));
    std::nth_element(spacings.begin(), usual, spacings.end());
    const double limit = kMinUsualSpacings * std::max(typical, *usual);
    MissingPart gaps;
    for (std::size_t i = 1; i < r.t.size(); ++i) {
        const double d = r.t[i] - r.t[i - 1];
        if (d <= limit) continue;
        ++gaps.count;
        if (d * r.scale.t_scale <= gaps.longest) continue;
        gaps.longest = d * r.scale.t_scale;
        gaps.at = r.scale.t_origin + r.scale.t_scale * r.t[i - 1];
    }
    if (gaps.count == 0) return;
    quality.gaps = gaps;
    quality.notes.push_back(std::to_string(gaps.count) + (gaps.count == 1 ? " gap" : " gaps") +
                            " without a usable sample, the longest of " + text(gaps.longest) +
                            " from t = " + text(gaps.at) +
                            "; nothing is interpolated, and u is assumed constant over "
                            "it.");
}

void describe_times(const Cleaning& done, DataQuality& quality) {
    quality.repeated_times = done.repeated;
    quality.backward_times = done.backward + done.early_stamps;
    auto& notes = quality.notes;
    if (done.reversed) notes.emplace_back("The rows run from the newest to the oldest; their order was reversed.");
    if (done.spread) {
        notes.emplace_back(
            "The clock is coarser than the sampling: rows with the same time were spread evenly until the next time.");
    } else if (done.repeated > 0) {
        notes.push_back(counted(done.repeated, "duplicate time stamp") + (done.repeated == 1 ? " (" : " (first ") +
                        row_text(done, done.first_repeated) + "): every y and the last u were used.");
    }
    if (done.backward > 0)
        notes.push_back(counted(done.backward, "row") + " with a time before that of the rows above removed (first " +
                        row_text(done, done.first_backward) + ").");
    if (done.early_stamps > 0)
        notes.push_back(counted(done.early_stamps, "row") + " with a time far ahead of the rows below removed (first " +
                        row_text(done, done.first_early) + ").");
    if (done.without_time > 0)
        notes.push_back(counted(done.without_time, "row") + " without a time, or before the first u, removed.");
    if (done.unread > 0)
        notes.push_back(counted(done.unread, "row") +
                        " at the start removed: at the next row u and y both jump by more than they move in all others "
                        "together, as if the logger wrote before its first reading.");
    if (done.silent > 0)
        notes.push_back(counted(done.silent, "row") +
                        " at the start removed: y is constant there and then jumps ten times as far as it ever moves "
                        "again, while u is constant, as if the sensor had not been read yet.");
    if (done.late_moves > 0)
        notes.push_back(counted(done.late_moves, "change") +
                        " of u at the last sample removed, because no sample "
                        "follows.");
    if (done.limited_u > 0)
        notes.push_back("u was limited to its range in " + counted(done.limited_u, "row") +
                        ", because that is the input of the plant.");
    if (done.missing_u > 0)
        notes.push_back("u is missing in " + counted(done.missing_u, "row") + "; the value of the row above was used.");
}

/// "line 102 (t = 2.02), line 103 (t = 2.04), ...".
std::string places_of_spikes(const Cleaning& done) {
    constexpr std::size_t kMaxRowsInSentence = 5;
    std::string places;
    for (std::size_t k = 0; k < std::min(kMaxRowsInSentence, done.spikes.size()); ++k)
        places += (k > 0 ? ", " : "") + row_text(done, done.spikes[k]) + " (t = " + text(done.spike_times[k], 10) + ")";
    return places + (done.spikes.size() > kMaxRowsInSentence ? ", ..." : "");
}

void describe_missing(const CleanRecord& r, DataQuality& quality) {
    const Cleaning& done = r.cleaning;
    if (done.missing_y > 0) {
        quality.missing = MissingPart{done.missing_y, done.hole_to - done.hole_from, done.hole_from};
        quality.notes.push_back("y is missing in " + counted(done.missing_y, "row") +
                                ", the longest time without it is " + text(quality.missing->longest) + " from t = " +
                                text(done.hole_from) + "; u of these rows was used, and y was not interpolated.");
    }
    if (done.spikes.empty()) return;
    constexpr std::size_t kMaxListedRows = 20, kMaxRowsInSentence = 5;
    std::string rows;
    for (std::size_t k = 0; k < std::min(kMaxRowsInSentence, done.spikes.size()); ++k)
        rows += (k > 0 ? ", " : "") + std::to_string(done.spikes[k]);
    FalseReadings outliers{static_cast<int>(done.spikes.size()), done.spikes};
    outliers.rows.resize(std::min(kMaxListedRows, outliers.rows.size()));
    quality.outliers = std::move(outliers);
    quality.notes.push_back(counted(static_cast<int>(done.spikes.size()), "plainly false reading") + " of y removed (" +
                            (done.from_file ? "line " : "row ") + rows +
                            (done.spikes.size() > kMaxRowsInSentence ? ", ..." : "") + ").");
}

bool on_a_level(const TwoLevels& u, double v) {
    constexpr double kLevelTolerance = 0.1;
    const double same = kLevelTolerance * (u.high - u.low);
    return std::abs(v - u.low) < same || std::abs(v - u.high) < same;
}

/// A straight line through the samples before the first change of u.
void describe_pretest(const CleanRecord& r, DataQuality& quality) {
    quality.u0 = r.scale.u_rest;
    const auto n = static_cast<int>(std::lower_bound(r.t.begin(), r.t.end(), r.v_time.front()) - r.t.begin());
    // A relay that works from the first sample leaves no part at rest.
    const bool at_work = quality.kind == RecordKind::relay && on_a_level(two_levels(input_levels(r)), 0);
    const std::span t(r.t.data(), static_cast<std::size_t>(n)), y(r.y.data(), static_cast<std::size_t>(n));
    const Line line = straight_line(t, y);
    const double y_mean = n == 0 || at_work ? r.y.front() : line.y_mean;
    quality.y0 = r.scale.y_origin + r.scale.y_scale * r.y_rest.value_or(y_mean);
    if (n > 0 && n < kRestRows && r.changes() == 1 && !r.u0_given)
        quality.notes.push_back("Only " + counted(n, "row") +
                                " before the step of u: too few to show whether the plant is at rest. Rest is assumed; "
                                "if it is not at rest, give u0.");
    if (n < 2 || t.back() <= t.front() || at_work) return;
    const double duration = t.back() - t.front();
    // Two samples determine a line but not its error.
    const double slope = line.slope, error = n > 2 ? line.slope_std : std::abs(slope);
    constexpr double kMaxDrift = 0.03, kSlopeStandardErrors = 5;  // of y's range; standard errors of the slope
    PreTest pretest{n, duration * r.scale.t_scale, slope * r.scale.y_scale / r.scale.t_scale, true};
    pretest.at_rest = std::abs(slope) * duration < kMaxDrift || std::abs(slope) < kSlopeStandardErrors * error;
    quality.pretest = pretest;
    quality.notes.push_back(
        std::to_string(n) + " samples before the first change of u give the operating point: u = " + text(quality.u0) +
        ", y = " + text(quality.y0) +
        (pretest.at_rest ? "."
                         : "; y is not at rest there but changes by " + text(pretest.drift) + " per unit of time."));
}

void describe_input(const CleanRecord& r, DataQuality& quality) {
    const InputLevels levels = input_levels(r);
    const RecordKind found = found_kind(r);
    quality.kind = r.kind == RecordKind::automatic ? found : r.kind;
    quality.steps = levels.moves();
    quality.move_times = move_times(r);
    if (quality.kind == RecordKind::relay) {
        const auto switches = static_cast<int>(two_levels(levels).switch_time.size());
        quality.cycles = std::max(0, (switches - 1) / 2);
        quality.notes.push_back("u is a relay's: " + std::to_string(switches) + " switches, " +
                                std::to_string(*quality.cycles) + " complete periods.");
    }
    const bool differs = r.kind == RecordKind::relay ? found != RecordKind::relay
                                                     : r.kind == RecordKind::step && found != RecordKind::step;
    if (differs)
        quality.notes.push_back(std::string("The record is stated to be of kind ") + name_of(r.kind) +
                                ", but by its u and y it looks like " + name_of(found) + ".");
}

void describe_output(const CleanRecord& r, DataQuality& quality) {
    const double noise = noise_std(r.y), grid = quantisation_step(r.y);
    quality.noise_std = noise * r.scale.y_scale;
    quality.quantisation = grid * r.scale.y_scale;
    constexpr double kMinGridOverNoise = 0.5, kMinVisibleGrid = 1e-3;  // of the noise; of y's range
    if (grid > kMinGridOverNoise * noise && grid > kMinVisibleGrid) {
        quality.notes.push_back("y is quantised in steps of " + text(quality.quantisation) + " (its range is " +
                                text(r.scale.y_scale) + ").");
    }
    quality.saturation = flat_tops(r, noise, grid);
    for (const Saturation& flat : quality.saturation) {
        quality.notes.push_back("y stands at " + text(flat.level) + " in " + text(100 * flat.fraction, 2) +
                                " % of the samples, cut off flat; they were used unchanged.");
    }
}

/// True if y has few levels while u moves all the time.
bool look_swapped(const CleanRecord& r) {
    int y_moves = 0;
    for (int i = 1; i < r.samples(); ++i) y_moves += r.y[i] != r.y[i - 1] ? 1 : 0;
    constexpr int kMaxMoves = 30;  // moves of y
    return y_moves > 0 && y_moves <= std::max(3, r.samples() / 100) && y_moves <= kMaxMoves &&
           2 * r.changes() > r.samples();
}

constexpr int kMinRun = 5;          ///< samples
constexpr double kMinShare = 0.01;  ///< of the samples

/// Movement of y over the few samples that end at i, per sample.
double speed(const CleanRecord& r, int i, int samples) {
    const int from = std::max(0, i - samples);
    return i > from ? std::abs(r.y[i] - r.y[from]) / (i - from) : 0;
}

double fastest(const CleanRecord& r, int samples) {
    double max = 0;
    for (int i = samples; i < r.samples(); ++i) max = std::max(max, speed(r, i, samples));
    return max;
}

/// True if y goes up and down from sample to sample, like noise and unlike a response.
bool alternates(const CleanRecord& r) {
    int turns = 0, moves = 0;
    double before = 0;
    for (int i = 1; i < r.samples(); ++i) {
        const double d = r.y[i] - r.y[i - 1];
        if (d == 0) continue;
        ++moves;
        turns += d * before < 0 ? 1 : 0;
        before = d;
    }
    constexpr double kMinTurningShare = 0.3;  // of the moves: white noise reverses in two thirds of them
    return turns > kMinTurningShare * moves;
}

/// True if y moved fast for some time before sample i: a jump over one or two samples is a fast process.
bool arrives_fast(const CleanRecord& r, int i, int window, double min_speed) {
    return i > 2 * window && speed(r, i, window) > min_speed && speed(r, i - window, window) > min_speed;
}

/// Samples in runs at `level` that were reached at speed; if `noisy`, every run counts.
int samples_at(const CleanRecord& r, double level, double same, bool noisy, double min_speed, int window) {
    int count = 0;
    for (int i = 0; i < r.samples();) {
        int end = i;
        while (end < r.samples() && std::abs(r.y[end] - level) <= same) ++end;
        if (end - i >= kMinRun && i > 0 && (noisy || arrives_fast(r, i, window, min_speed))) count += end - i;
        i = std::max(end, i + 1);
    }
    return count;
}

}  // namespace

DataQuality describe_record(const CleanRecord& r) {
    DataQuality quality;
    quality.samples = r.samples();
    quality.samples_dropped = r.dropped;
    describe_times(r.cleaning, quality);
    describe_sampling(r, quality);
    describe_missing(r, quality);
    describe_input(r, quality);
    describe_pretest(r, quality);
    describe_output(r, quality);
    return quality;
}

std::vector<Warning> record_warnings(const CleanRecord& r, const DataQuality& quality) {
    std::vector<Warning> warnings;
    const Cleaning& done = r.cleaning;
    for (const Saturation& flat : quality.saturation) {
        warnings.push_back({"saturated-output",
                            "y is cut off at " + text(flat.level) + " in " + text(100 * flat.fraction, 2) +
                                " % of the samples: a sensor or a valve was at its end, which no linear model can "
                                "represent. Repeat the test with a smaller step, or use only the record before that."});
    }
    constexpr double kLongGap = 0.03, kManyMissing = 0.05;  // of the record's length; of its rows
    if (quality.gaps && quality.gaps->longest > kLongGap * r.scale.t_scale) {
        warnings.push_back({"gaps", "Nothing was recorded for " + text(quality.gaps->longest) +
                                        " from t = " + text(quality.gaps->at) + ", " +
                                        text(100 * quality.gaps->longest / r.scale.t_scale, 2) +
                                        " % of the record, so a change of u inside it would be unknown."});
    }
    if (quality.missing && (quality.missing->count > kManyMissing * (r.samples() + quality.missing->count) ||
                            quality.missing->longest > kLongGap * r.scale.t_scale)) {
        warnings.push_back({"missing-samples", "y is missing in " + std::to_string(quality.missing->count) + " of " +
                                                   std::to_string(r.samples() + quality.missing->count) +
                                                   " rows, for up to " + text(quality.missing->longest) + " from t = " +
                                                   text(quality.missing->at) + "; the model is based on the others."});
    }
    if (quality.outliers) {
        warnings.push_back({"removed-outliers", std::to_string(quality.outliers->count) +
                                                    " physically impossible reading(s) of y were removed: " +
                                                    places_of_spikes(done) + ". Check whether they are false."});
    }
    if (done.reversed)
        warnings.push_back({"reversed-time",
                            "The times run backward from row to row; the record was reversed. Check whether it is the "
                            "intended test."});
    if (quality.backward_times > 0) {
        warnings.push_back(
            {"misplaced-times", std::to_string(quality.backward_times) + " row(s) are out of order in time (first " +
                                    row_text(done, done.backward > 0 ? done.first_backward : done.first_early) +
                                    ") and were removed."});
    }
    constexpr int kMinSamples = 30;
    if (r.samples() < kMinSamples)
        warnings.push_back(
            {"few-samples", "The record has only " + std::to_string(r.samples()) +
                                " samples: an error in any one of them changes the model. Use a shorter sample time."});
    if (look_swapped(r))
        warnings.push_back({"columns-look-swapped",
                            "y stays on a few levels while u moves from sample to sample: u and y look exchanged. Set "
                            "them in columns."});
    return warnings;
}

std::vector<Saturation> flat_tops(const CleanRecord& r, double noise, double grid) {
    constexpr double kValueTolerance = 1e-9;                  // of y's range: rounding in binary
    constexpr double kMaxGrid = 1.0 / 30;                     // of y's range: with so few steps y would always be
                                                              // constant
    constexpr double kMinNoiseInGrids = 2, kMinNoise = 1e-3;  // steps of the grid; of y's range
    constexpr double kMinSpeedShare = 1.0 / 6;                // of y's fastest movement
    if (grid > kMaxGrid) return {};
    const int window = std::clamp(r.samples() / 200, 3, 50);
    const double min_speed = kMinSpeedShare * fastest(r, window);
    const bool noisy = noise > kMinNoiseInGrids * grid && noise > kMinNoise && alternates(r);
    std::vector<Saturation> found;
    for (const double level : {0.0, 1.0}) {
        const int count = samples_at(r, level, kValueTolerance, noisy, min_speed, window);
        if (count < kMinShare * r.samples() || count < kMinRun) continue;
        found.push_back({r.scale.y_origin + r.scale.y_scale * level, static_cast<double>(count) / r.samples()});
    }
    return found;
}

namespace {

/// True if the limits hide more than a quarter of the moves between levels at which u is constant: then a test stepped
/// it there.
bool hides_steps(const Record& record, const InputLimits& limits) {
    constexpr std::size_t kMinStandingRows = 3;  // rows
    int moves = 0, hidden = 0;
    std::optional<double> before;
    for (std::size_t i = 0, end = 0; i < record.u.size(); i = end) {
        end = i + 1;
        while (end < record.u.size() && record.u[end] == record.u[i]) ++end;
        if (end - i < kMinStandingRows) continue;
        if (before && *before != record.u[i]) {
            ++moves;
            hidden +=
                std::clamp(*before, limits[0], limits[1]) == std::clamp(record.u[i], limits[0], limits[1]) ? 1 : 0;
        }
        before = record.u[i];
    }
    return 4 * hidden > moves;
}

}  // namespace

std::vector<InputLimits> plain_limits(const Record& record) {
    static constexpr InputLimits kUsualLimits[] = {{0, 1},   {-1, 1},     {0, 100},  {-100, 100},
                                                   {0, 255}, {-255, 255}, {0, 1023}, {0, 4095}};
    constexpr double kLimitMargin = 0.05, kMinOutside = 0.02, kMinInside = 0.1;
    std::vector<InputLimits> found;
    for (const InputLimits& limits : kUsualLimits) {
        const auto [low, high] = limits;
        if (record.u_full_scale && high < *record.u_full_scale) continue;
        const double margin = kLimitMargin * (high - low);
        int inside = 0, outside = 0, all = 0;
        for (const double u : record.u) {
            if (!std::isfinite(u)) continue;
            ++all;
            inside += u > low && u < high ? 1 : 0;
            outside += u < low - margin || u > high + margin ? 1 : 0;
        }
        if (inside > kMinInside * all && outside > kMinOutside * all && !hides_steps(record, limits))
            found.push_back(limits);
    }
    return found;
}

}  // namespace tunewright
