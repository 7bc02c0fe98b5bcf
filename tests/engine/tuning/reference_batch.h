// The 94 plants of the AMIGO batch with their reference values (tests/data/robust).
#pragma once

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "engine/plant/plant.h"
#include "tests/test_data.h"

namespace tunewright::test {

inline Zpk plant_of(const nlohmann::json& row) {
    const auto& given = row.at("plant");
    const auto& factors = given.at("factors");
    Zpk plant;
    plant.K = factors.at("gain");
    plant.L = given.at("delay");
    for (int i = 0; i < factors.at("nint").get<int>(); ++i) plant.poles.emplace_back(0.0);
    for (const double lag : factors.at("lag")) {
        plant.poles.emplace_back(-1 / lag);
        plant.K /= lag;
    }
    for (const auto& quad : factors.at("quad")) {  // a s^2 + b s + 1
        const double a = quad.at(0), b = quad.at(1);
        const auto root = std::sqrt(std::complex<double>(b * b - 4 * a));
        plant.poles.push_back((-b + root) / (2 * a));
        plant.poles.push_back((-b - root) / (2 * a));
        plant.K /= a;
    }
    for (const double lead : factors.at("zero")) {  // lead s + 1
        plant.zeros.emplace_back(-1 / lead);
        plant.K *= lead;
    }
    return plant;
}

inline const nlohmann::json& reference_rows() {
    static const nlohmann::json rows = [] {
        std::ifstream file(test_data("robust/public.json"));
        return nlohmann::json::parse(file).at("rows");
    }();
    return rows;
}

}  // namespace tunewright::test
