#include "api/historian/values/joined_tags.h"

#include <algorithm>
#include <cmath>

#include "api/historian/values/value_cells.h"

namespace tunewright::api {
namespace {

constexpr std::size_t kMinSampledRows = 20;  ///< fewer values do not show how y was stored
constexpr double kSilence = 2.5;             ///< usual spacings
constexpr double kRegularShare = 0.8;        ///< of the spacings that are usual in a sampled record
constexpr double kUsualTolerance = 0.2;      ///< relative, of a usual spacing

/// The median of the spacings; 0 if there are none.
double usual_spacing(const std::vector<double>& t) {
    if (t.size() < 2) return 0;
    std::vector<double> spacings(t.size() - 1);
    for (std::size_t i = 1; i < t.size(); ++i) spacings[i - 1] = t[i] - t[i - 1];
    const auto middle = spacings.begin() + static_cast<std::ptrdiff_t>(spacings.size() / 2);
    std::ranges::nth_element(spacings, middle);
    return *middle;
}

bool is_sampled(const std::vector<double>& t, double usual) {
    std::size_t near = 0;
    for (std::size_t i = 1; i < t.size(); ++i)
        near += std::abs(t[i] - t[i - 1] - usual) <= kUsualTolerance * usual ? 1 : 0;
    return static_cast<double>(near) >= kRegularShare * static_cast<double>(t.size() - 1);
}

/// The times of the rows: those of y, and those of u where y is silent.
std::vector<double> row_times(const std::vector<double>& y, const std::vector<double>& u) {
    const bool few = y.size() < kMinSampledRows;
    const double usual = usual_spacing(few ? u : y);
    if (y.empty() || (!few && is_sampled(y, usual))) return y;
    std::vector<double> out;
    out.reserve(y.size());
    auto next = u.begin();
    const auto add_silence = [&](double from, double to) {
        next = std::upper_bound(next, u.end(), from);
        while (next != u.end() && *next < to) out.push_back(*next++);
    };
    for (std::size_t i = 0; i < y.size(); ++i) {
        if (i > 0 && y[i] - y[i - 1] > kSilence * usual) add_silence(y[i - 1], y[i]);
        out.push_back(y[i]);
    }
    if (!u.empty() && u.back() - y.back() > kSilence * usual) add_silence(y.back(), std::nextafter(u.back(), INFINITY));
    return out;
}

/// The values at ascending times, each held until the next one; NaN before the first.
std::vector<double> held_at(const std::vector<double>& times, const TagValues& tag) {
    std::vector<double> out;
    out.reserve(times.size());
    std::size_t next = 0;
    for (const double t : times) {
        while (next < tag.t.size() && tag.t[next] <= t) ++next;
        out.push_back(next > 0 ? tag.value[next - 1] : kNoNumber);
    }
    return out;
}

}  // namespace

void put_in_order(TagValues& tag) {
    const std::vector<std::size_t> rows = time_order(tag.t);
    if (rows.empty()) return;
    take_rows(rows, tag.value);
    take_rows(rows, tag.t);
}

void put_in_order(TagModes& tag) {
    const std::vector<std::size_t> rows = time_order(tag.t);
    if (rows.empty()) return;
    take_rows(rows, tag.mode);
    take_rows(rows, tag.t);
}

std::string apart_sentence(const TagValues& y, const std::string& y_name, const TagValues& u,
                           const std::string& u_name) {
    if (y.t.empty() || u.t.empty() || y.t.back() >= u.t.front()) return {};
    return u_name + " begins after " + y_name + " has ended. Export both for the same time.";
}

void join_tags(const TagValues& y, const TagValues& u, const TagValues& r, const TagModes& mode, TaggedLoop& loop) {
    loop.t = row_times(y.t, u.t);
    loop.y = held_at(loop.t, y);
    loop.u = held_at(loop.t, u);
    if (!r.t.empty()) loop.r = held_at(loop.t, r);
    if (mode.t.empty()) return;
    loop.mode.reserve(loop.t.size());
    std::size_t next = 0;
    for (const double t : loop.t) {
        while (next < mode.t.size() && mode.t[next] <= t) ++next;
        loop.mode.push_back(next > 0 ? mode.mode[next - 1] : std::uint8_t{0});
    }
}

}  // namespace tunewright::api
