#include "engine/identification/fit/starting_values.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace tunewright {
namespace {

std::vector<double> geometric(double from, double to, int count) {
    std::vector<double> values;
    values.reserve(static_cast<std::size_t>(count));
    for (int i = 0; i < count; ++i) values.push_back(from * std::pow(to / from, static_cast<double>(i) / (count - 1)));
    return values;
}

/// 0, then geometric; for an input of many changes also `even` ones evenly spaced, because each interval between
/// changes can contain a minimum.
std::vector<double> dead_times(const CleanRecord& r, int even) {
    const double longest = 0.8 * r.response_time();
    const double spacing = 1.0 / std::max(1, r.samples() - 1);
    std::vector<double> values = geometric(std::min(0.5 * spacing, 0.1 * longest), longest, 10);
    values.push_back(0);
    if (r.changes() > 2) {
        for (int i = 1; i <= even; ++i) values.push_back(0.5 * longest * i / (even + 1));
    }
    std::sort(values.begin(), values.end());
    return values;
}

ModelShape at(Structure structure, double L, double T, double rho, double load_time = 0, double T3 = 1) {
    return {structure, {L, std::log(T), std::log(rho), load_time, std::log(T3)}};
}

/// A third lag added to a fitted second order, from nearly 0 to the longest, with the others shortened accordingly; the
/// fitted shape first.
std::vector<ModelShape> third_from(const ModelShape& second) {
    const double L = second.L(), a1 = second.a1(), rho = second.a2() / (a1 * a1), load = second.load_time();
    const double slow = std::sqrt(second.a2());
    std::vector<ModelShape> shapes = {at(Structure::third, L, a1, rho, load, 1e-3 * a1)};
    if (rho > 0.25) {
        for (const double lag : {0.1, 0.4, 1.2})
            shapes.push_back(at(Structure::third, 0.5 * L, a1, rho, load, lag * slow));
        return shapes;
    }
    // A share of the two lags and the dead time becomes the third lag.
    const double longest = 0.5 * a1 * (1 + std::sqrt(std::max(0.0, 1 - 4 * rho))), shorter = a1 - longest;
    for (const double part : {0.25, 0.6, 0.95}) {
        const double spare = part * L + shorter, lag = 0.5 * spare;
        shapes.push_back(at(Structure::third, (1 - part) * L, spare, 0.2, load, longest));
        shapes.push_back(at(Structure::third, (1 - part) * L, longest + lag,
                            longest * lag / ((longest + lag) * (longest + lag)), load, lag));
    }
    return shapes;
}

/// Every combination of the axes' values, the last axis fastest.
struct Grid {
    std::array<int, 4> size{};
    std::vector<ModelShape> shapes;

    /// True if no neighbour along an axis is lower.
    bool is_local_minimum(const std::vector<double>& values, int index) const {
        int stride = 1, left = index;
        for (int axis = 3; axis >= 0; --axis) {
            const int place = left % size[axis];
            if (place > 0 && values[index - stride] < values[index]) return false;
            if (place + 1 < size[axis] && values[index + stride] < values[index]) return false;
            left /= size[axis];
            stride *= size[axis];
        }
        return true;
    }
};

/// The first move of u, and times spread over the record: a load may begin with the test or at any time.
std::vector<double> load_times(const CleanRecord& r) {
    std::vector<double> values = {r.v_time.front()};
    for (int i = 1; i < 12; ++i) values.push_back(i / 12.0);
    std::sort(values.begin(), values.end());
    return values;
}

Grid scan_grid(const CleanRecord& r, const ModelForm& form) {
    const Structure structure = form.structure;
    const double spacing = 1.0 / std::max(1, r.samples() - 1);
    const std::vector<double> L = dead_times(r, form.load || structure == Structure::sopdt_zero ? 0
                                                : shape_size(structure) > 2                     ? 8
                                                                                                : 23);
    std::vector<double> T = {1}, rho = {1}, load = {0};
    if (shape_size(structure) > 1) T = geometric(0.5 * spacing, 4.0, 10);
    if (structure == Structure::unstable) T = geometric(0.05, 2.0, 12);
    if (shape_size(structure) > 2) rho = {0.05, 0.25, 1.5, 10};
    // Its denominator has already been searched for sopdt.
    if (structure == Structure::sopdt_zero) T = geometric(spacing, 2.0, 8), rho = {0.1, 0.25, 1.5};
    if (form.load) load = load_times(r);
    Grid grid{{static_cast<int>(L.size()), static_cast<int>(T.size()), static_cast<int>(rho.size()),
               static_cast<int>(load.size())},
              {}};
    for (double dead_time : L) {
        for (double lag : T) {
            for (double ratio : rho) {
                for (double time : load) grid.shapes.push_back(at(structure, dead_time, lag, ratio, time));
            }
        }
    }
    return grid;
}

}  // namespace

std::vector<ModelShape> scan_shapes(const FitData& data, const ModelForm& form, int max, const std::stop_token& stop) {
    // The time of a load adds a dimension to the scan: larger structures start from the results of the smaller ones.
    // The largest always do.
    if (form.load && shape_size(form.structure) > 2) return {};
    if (form.structure == Structure::third || form.structure == Structure::ipdt_second) return {};
    const Grid grid = scan_grid(*data.record, form);
    const std::vector<double> sums = sums_of_squares(data, form, grid.shapes, stop);
    std::vector<int> minima;
    for (int i = 0; i < static_cast<int>(sums.size()); ++i) {
        if (grid.is_local_minimum(sums, i)) minima.push_back(i);
    }
    std::stable_sort(minima.begin(), minima.end(), [&](int a, int b) { return sums[a] < sums[b]; });
    std::vector<ModelShape> best;
    for (int i : minima) {
        if (static_cast<int>(best.size()) < max) best.push_back(grid.shapes[i]);
    }
    return best;
}

std::vector<ModelShape> extend_shape(const ModelShape& simpler, Structure structure) {
    const double L = simpler.L(), load = simpler.load_time();
    const bool wider = structure == Structure::sopdt || structure == Structure::sopdt_zero;
    if (simpler.structure == Structure::fopdt && wider) {
        const double T = simpler.T();
        return {at(structure, L, T, 1e-3, load), at(structure, 0.5 * L, T + 0.5 * L, 0.15, load),
                at(structure, 0.2 * L, T + 0.8 * L, 0.24, load)};
    }
    if (simpler.structure == Structure::sopdt && structure == Structure::sopdt_zero) {
        ModelShape shape = simpler;
        shape.structure = structure;
        return {shape};
    }
    if (simpler.structure == Structure::sopdt && structure == Structure::third) return third_from(simpler);
    if (simpler.structure == Structure::ipdt_lag && structure == Structure::ipdt_second) {
        const double T = simpler.T(), spare = 0.5 * L;
        return {at(structure, L, T, 1e-3, load), at(structure, spare, T + spare, 0.2, load),
                at(structure, L, T, 0.25, load), at(structure, L, T, 1.5, load)};
    }
    if (simpler.structure == Structure::ipdt && structure == Structure::ipdt_lag) {
        const double sum = std::max(L, 1e-4);
        return {at(structure, L, 0.01 * sum, 1, load), at(structure, 0.5 * sum, 0.5 * sum, 1, load),
                at(structure, 0, sum, 1, load)};
    }
    return {};
}

}  // namespace tunewright
