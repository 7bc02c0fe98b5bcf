#include "engine/range/model/parameters.h"

#include <algorithm>
#include <cmath>
#include <type_traits>
#include <utility>

namespace tunewright::range {
namespace {

/// Calls f with a reference to each number of the structure, in order.
template <class PlantType, class F>
void for_each_number(PlantType& plant, F f) {
    using Type = std::remove_const_t<PlantType>;
    if constexpr (std::is_same_v<Type, Fopdt> || std::is_same_v<Type, Ipdt>) {
        f(plant.K), f(plant.T), f(plant.L);
    } else if constexpr (std::is_same_v<Type, Sopdt>) {
        f(plant.K), f(plant.T1), f(plant.T2), f(plant.L);
    } else if constexpr (std::is_same_v<Type, OscillatorySopdt>) {
        f(plant.K), f(plant.T), f(plant.zeta), f(plant.L);
    } else if constexpr (std::is_same_v<Type, TransferFunction>) {
        for (auto& coefficient : plant.num) f(coefficient);
        for (auto& coefficient : plant.den) f(coefficient);
        f(plant.L);
    } else {
        static_assert(std::is_same_v<Type, Zpk> || std::is_same_v<Type, StateSpace>, "Name the numbers of this type.");
    }
}

/// Sorts the lags in descending order, so that the slower one of a plant is interpolated with the slower one of its
/// neighbour.
Plant in_order(Plant plant) {
    if (auto* two = std::get_if<Sopdt>(&plant); two && two->T1 < two->T2) std::swap(two->T1, two->T2);
    return plant;
}

Plant with_numbers(Plant plant, const std::vector<double>& numbers) {
    std::size_t next = 0;
    std::visit([&](auto& of_type) { for_each_number(of_type, [&](double& number) { number = numbers[next++]; }); },
               plant);
    return plant;
}

}  // namespace

std::vector<double> structure_numbers(const Plant& plant) {
    const Plant ordered = in_order(plant);
    std::vector<double> numbers;
    std::visit([&](auto& of_type) { for_each_number(of_type, [&](double number) { numbers.push_back(number); }); },
               ordered);
    return numbers;
}

bool same_structure(const Plant& one, const Plant& other) {
    if (one.index() != other.index()) return false;
    const auto* a = std::get_if<TransferFunction>(&one);
    const auto* b = std::get_if<TransferFunction>(&other);
    if (a && b && (a->num.size() != b->num.size() || a->den.size() != b->den.size())) return false;
    return !structure_numbers(one).empty();
}

Plant plant_between(const Plant& left, const Plant& right, double share) {
    const auto a = structure_numbers(left), b = structure_numbers(right);
    std::vector<double> between;
    for (std::size_t i = 0; i < a.size(); ++i)
        between.push_back(a[i] * b[i] > 0 ? a[i] * std::pow(b[i] / a[i], share) : a[i] + share * (b[i] - a[i]));
    Plant plant = with_numbers(in_order(left), between);
    std::visit([](auto& of_type) { of_type.uncertainty = {}; }, plant);
    return plant;
}

std::vector<double> log_ratios(const Plant& nominal, const Plant& member) {
    auto ratios = structure_numbers(member);
    const auto from = structure_numbers(nominal);
    for (std::size_t i = 0; i < ratios.size(); ++i)
        ratios[i] = ratios[i] * from[i] > 0 ? std::log(ratios[i] / from[i]) : 0;
    return ratios;
}

Plant moved_by(const Plant& plant, const std::vector<double>& log_ratios) {
    auto numbers = structure_numbers(plant);
    for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] *= std::exp(log_ratios[i]);
    numbers.back() = std::max(0.0, numbers.back());
    return with_numbers(in_order(plant), numbers);
}

}  // namespace tunewright::range
