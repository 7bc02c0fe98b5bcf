#include "engine/identification/starting_values.h"

#include <algorithm>
#include <cmath>

namespace tunewright {
namespace {

std::vector<double> geometric(double from, double to, int count) {
    std::vector<double> values;
    for (int i = 0; i < count; ++i) values.push_back(from * std::pow(to / from, static_cast<double>(i) / (count - 1)));
    return values;
}

/// 0, then geometric; for an input of many changes also evenly spaced, because each interval between changes can hold a
/// minimum.
std::vector<double> dead_times(const CleanRecord& r) {
    const double longest = 0.8 * r.response_time();
    const double spacing = 1.0 / std::max(1, r.samples() - 1);
    std::vector<double> values = geometric(std::min(0.5 * spacing, 0.1 * longest), longest, 10);
    values.push_back(0);
    if (r.changes() > 2) {
        for (int i = 1; i < 24; ++i) values.push_back(0.5 * longest * i / 24);
    }
    std::sort(values.begin(), values.end());
    return values;
}

struct Axes {
    std::vector<double> L, T, rho;
};

Axes scan_axes(const CleanRecord& r, Structure structure) {
    Axes axes;
    axes.L = dead_times(r);
    const double spacing = 1.0 / std::max(1, r.samples() - 1);
    const int size = shape_size(structure);
    axes.T = size > 1 ? geometric(0.5 * spacing, 4.0, 10) : std::vector<double>{1};
    axes.rho = size > 2 ? std::vector<double>{0.05, 0.25, 1.5, 10} : std::vector<double>{1};
    return axes;
}

Shape at(Structure structure, double L, double T, double rho) { return {structure, {L, std::log(T), std::log(rho)}}; }

}  // namespace

std::vector<Shape> scan_shapes(const CleanRecord& record, const ModelForm& form, int most, std::stop_token stop) {
    const Axes axes = scan_axes(record, form.structure);
    const int nL = static_cast<int>(axes.L.size()), nT = static_cast<int>(axes.T.size()),
              nr = static_cast<int>(axes.rho.size());
    std::vector<double> sse(static_cast<std::size_t>(nL) * nT * nr);
    auto index = [&](int i, int j, int k) { return (static_cast<std::size_t>(i) * nT + j) * nr + k; };
    for (int i = 0; i < nL && !stop.stop_requested(); ++i) {
        for (int j = 0; j < nT; ++j) {
            for (int k = 0; k < nr; ++k)
                sse[index(i, j, k)] = project(record, form, at(form.structure, axes.L[i], axes.T[j], axes.rho[k])).sse;
        }
    }
    auto lowest_of_neighbours = [&](int i, int j, int k) {
        const double here = sse[index(i, j, k)];
        return !((i > 0 && sse[index(i - 1, j, k)] < here) || (i + 1 < nL && sse[index(i + 1, j, k)] < here) ||
                 (j > 0 && sse[index(i, j - 1, k)] < here) || (j + 1 < nT && sse[index(i, j + 1, k)] < here) ||
                 (k > 0 && sse[index(i, j, k - 1)] < here) || (k + 1 < nr && sse[index(i, j, k + 1)] < here));
    };
    std::vector<std::pair<double, Shape>> minima;
    for (int i = 0; i < nL; ++i) {
        for (int j = 0; j < nT; ++j) {
            for (int k = 0; k < nr; ++k) {
                if (lowest_of_neighbours(i, j, k))
                    minima.emplace_back(sse[index(i, j, k)], at(form.structure, axes.L[i], axes.T[j], axes.rho[k]));
            }
        }
    }
    std::stable_sort(minima.begin(), minima.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    std::vector<Shape> best;
    for (int i = 0; i < std::min<int>(most, static_cast<int>(minima.size())); ++i) best.push_back(minima[i].second);
    return best;
}

std::vector<Shape> extend_shape(const Shape& simpler, Structure structure) {
    const double L = simpler.L();
    const bool wider = structure == Structure::sopdt || structure == Structure::sopdt_zero;
    if (simpler.structure == Structure::fopdt && wider) {
        const double T = simpler.T();
        return {at(structure, L, T, 1e-3), at(structure, 0.5 * L, T + 0.5 * L, 0.15),
                at(structure, 0.2 * L, T + 0.8 * L, 0.24)};
    }
    if (simpler.structure == Structure::sopdt && structure == Structure::sopdt_zero) {
        Shape shape = simpler;
        shape.structure = structure;
        return {shape};
    }
    if (simpler.structure == Structure::ipdt && structure == Structure::ipdt_lag) {
        const double sum = std::max(L, 1e-4);
        return {at(structure, L, 0.01 * sum, 1), at(structure, 0.5 * sum, 0.5 * sum, 1), at(structure, 0, sum, 1)};
    }
    return {};
}

}  // namespace tunewright
