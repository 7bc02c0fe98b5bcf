// Oscillation, law and valves against an independent program (tests/data/check).
#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <sstream>

#include "engine/check/oscillation/peak_search.h"
#include "engine/check/pace/loop_law.h"
#include "engine/check/valve/valve_model.h"
#include "tests/test_data.h"

namespace tunewright::check {
namespace {

using Columns = std::map<std::string, std::vector<double>>;

Columns columns_of(const std::string& name) {
    std::ifstream in(test_data("check/" + name));
    std::string line, cell;
    std::vector<std::string> names;
    std::getline(in, line);
    for (std::istringstream heads(line); std::getline(heads, cell, ',');) names.push_back(cell);
    Columns out;
    while (std::getline(in, line)) {
        std::istringstream cells(line);
        for (const std::string& column : names) {
            std::getline(cells, cell, ',');
            out[column].push_back(std::stod(cell));
        }
    }
    EXPECT_FALSE(out.empty()) << name;
    return out;
}

TEST(CheckReference, Oscillations) {
    const Columns columns = columns_of("oscillation.csv");
    const Peak sine = PeakSearch(columns.at("sine")).strongest(), square = PeakSearch(columns.at("square")).strongest();
    EXPECT_NEAR(sine.period, 37.2765241, 0.02);
    EXPECT_NEAR(square.period, 49.9356074, 0.03);
    EXPECT_NEAR(sine.line_period, 37.3018534, 0.01);
    EXPECT_NEAR(square.line_period, 49.9628069, 0.01);
    EXPECT_NEAR(sine.line, 0.984582, 5e-3);
    EXPECT_NEAR(square.line, 0.996471, 5e-3);
    EXPECT_NEAR(sine.persistence, 0.996059, 0.01);
    EXPECT_GT(sine.regularity, 50);
    EXPECT_GT(square.regularity, 50);
    EXPECT_NEAR(sine.share, 0.877650, 0.02);
}

TEST(CheckReference, Law) {
    const Columns columns = columns_of("law.csv");
    const LoopLaw law = loop_law(columns.at("e"), columns.at("u"), 1);
    EXPECT_NEAR(law.gain, 1.3327734821951922, 1e-6);
    EXPECT_NEAR(law.Ti, 20.492503392408036, 1e-4);
    EXPECT_NEAR(law.explained, 0.9999960159798572, 1e-8);
}

TEST(CheckReference, Valves) {
    const Columns columns = columns_of("valves.csv");
    const std::vector<std::pair<double, double>> bands = {{2, 0}, {2, 1}, {4, 2}, {4, 4}, {3, 3}};
    for (std::size_t k = 0; k < bands.size(); ++k) {
        for (const auto kind : {ValveModel::Kind::he, ValveModel::Kind::kano}) {
            const bool kano = kind == ValveModel::Kind::kano;
            if (kano && k == 0) continue;
            const auto& expected = columns.at((kano ? "kano" : "he") + std::to_string(k));
            const auto found = valve_position(columns.at("u"), {kind, bands[k].first, bands[k].second});
            for (std::size_t i = 0; i < expected.size(); ++i)
                ASSERT_NEAR(found[i], expected[i], 1e-4) << (kano ? "Kano " : "He ") << k << " row " << i;
        }
    }
}

}  // namespace
}  // namespace tunewright::check
