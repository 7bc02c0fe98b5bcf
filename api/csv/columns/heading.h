// The meaning of a heading: the quantity's role in a record, and its unit.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tunewright::api {

/// The columns of a record. The values are the indices of arrays with an element for each role.
enum ColumnRole : std::size_t { kTimeRole, kInputRole, kOutputRole, kReferenceRole, kModeRole, kRoleCount };
/// For any number of columns; they must be chosen.
inline constexpr ColumnRole kDisturbanceRole = kRoleCount;
constexpr std::array<ColumnRole, kRoleCount> kRoles = {kTimeRole, kInputRole, kOutputRole, kReferenceRole, kModeRole};

std::string role_name(ColumnRole role);     ///< "t", "u", "y", "r", "mode" or "d"
std::string role_meaning(ColumnRole role);  ///< "time", "the controller output", "the measurement", ...

struct Heading {
    std::string text;                ///< as written, trimmed
    std::string name;                ///< lower case, without unit
    std::string unit;                ///< as written; "" if none
    std::vector<std::string> words;  ///< of the name, also split where "targetTemp" begins a new word; lower case
};

/// Splits "PV [degC]", "PV (degC)", "PV / degC", "PV, degC", "time_ms" into name and unit.
Heading split_heading(std::string_view text);

/// How clearly a heading names a role: 1 is an exact name ("PV", "time"), with `order` by preference; 2 a tag that ends
/// in one ("TIC101.PV", "TIC101/PID1/OUT.CV", "Temp1"); 3 a name that holds one as a word ("Reactor temperature A").
struct NameMatch {
    int level = 0;
    int order = 0;
};

std::optional<NameMatch> match(const Heading& heading, ColumnRole role);

/// True for a heading that marks the measured column of a pair: "measured_rpm", "actual speed". Plain "speed" next to
/// it may be the command.
bool is_measured(const Heading& heading);

/// True for "cmd", "command": the set point if another column is u, else u.
bool is_command(const Heading& heading);

/// True for row numbers, which exports put first.
bool is_index(std::string_view heading);

/// True for the spacing of the samples: "Ts", "dt", "sample time".
bool is_spacing(const Heading& heading);

/// True for a sampling frequency: "fs", "sample rate".
bool is_frequency(const Heading& heading);

/// True for "ssr_output_percent", "duty %", "heater_pct".
bool is_percent(const Heading& heading);

/// True for a figure of the sensor, its radio or its supply, or a quantity next to the process: signal quality,
/// battery, humidity. Never u unless chosen.
bool is_never_input(const Heading& heading);

/// True for set points, qualities, modes, alarms, the weather: never y or u unless chosen.
bool is_auxiliary(const Heading& heading);

/// True for "heater state", "pump status", "state": u if the column switches.
bool is_state(const Heading& heading);

/// True for a controller's internal quantities: "error", "P", "I-Term". The letters alone count only if `with_letters`.
bool is_controller_term(const Heading& heading, bool with_letters);
bool is_term_letter(const Heading& heading);

/// The part of the heading before the word that names the role: "heater_bed.temp" and "heater_bed.pwm" belong together.
std::string stem(const Heading& heading);

/// The same of a heading that names a mode: "TIC101.MODE.ACTUAL" belongs to "TIC101.PV".
std::string mode_stem(const Heading& heading);

/// The number behind the last word of "heater 1" and "Temperature 1"; "" for none.
std::string number_behind(const Heading& heading);

}  // namespace tunewright::api
