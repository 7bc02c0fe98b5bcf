// Reads the columns of a recorded test for the tests; the product has its own CSV reader.
#pragma once

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "engine/identification/record/record.h"
#include "tests/test_data.h"

namespace tunewright::testing {

inline std::vector<std::string> cells_of(const std::string& line) {
    std::vector<std::string> cells;
    std::stringstream stream(line);
    for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(cell);
    return cells;
}

/// Columns by heading from tests/data/records/<file>; a text that is not a number becomes NaN.
inline Record read_record(const std::string& file, const std::string& t = "t", const std::string& u = "u",
                          const std::string& y = "y") {
    std::ifstream stream(test_data("records/" + file));
    std::string line;
    if (!std::getline(stream, line)) throw std::runtime_error("cannot read " + file);
    const std::vector<std::string> headings = cells_of(line);
    auto column = [&](const std::string& name) {
        return static_cast<std::size_t>(std::find(headings.begin(), headings.end(), name) - headings.begin());
    };
    const std::size_t columns[3] = {column(t), column(u), column(y)};
    Record record;
    std::vector<double>* targets[3] = {&record.t, &record.u, &record.y};
    while (std::getline(stream, line)) {
        const std::vector<std::string> cells = cells_of(line);
        for (int k = 0; k < 3; ++k) {
            const bool number = columns[k] < cells.size() && !cells[columns[k]].empty();
            targets[k]->push_back(number ? std::stod(cells[columns[k]]) : std::numeric_limits<double>::quiet_NaN());
        }
    }
    return record;
}

}  // namespace tunewright::testing
