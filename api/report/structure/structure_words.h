// Answers about loops around the loop in words: their conclusions, controllers and figures, for reports and terminals.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "api/json/json.h"

namespace tunewright::api {

/// "Cascade" for "cascade"; an unknown name unchanged.
std::string structure_title(std::string_view structure);

/// Labels of units; empty: none.
struct StructureUnits {
    std::string time, y;
};

/// {"code", "figures"} as sentences; an unknown code unchanged.
std::string conclusion_sentence(const Json& conclusion, const StructureUnits& units);

/// A controller of the answer by its place, with its name: "Outer controller", "Controller 1: y1 by u2".
struct StructureController {
    std::string name, pointer;
};
/// Those that are typed, in the order of the answer.
std::vector<StructureController> structure_controllers(const Json& result);

/// A figure of the answer by its place: "Ms of the inner loop", "/inner/robustness/Ms". `unit`: "time", "y", "y time",
/// "u/time" or "".
struct StructureFigure {
    std::string name, pointer, unit;
};
std::vector<StructureFigure> structure_figures(const Json& result);

/// "single loop" for "single": whose series they are. An unknown name with blanks.
std::string series_title(std::string_view of);
/// "at the valve" for "valve": where a loop is broken.
std::string loop_title(std::string_view loop);
/// "Load at the valve" for "inner_load"; "Load at the plant input 2" for "load_2".
std::string input_title(std::string_view input);

}  // namespace tunewright::api
