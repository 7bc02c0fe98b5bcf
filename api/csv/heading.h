// What a heading says: the quantity's role in a record, and its unit.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

namespace tunewright::api {

/// t, u and y, in this order: index of arrays.
enum Role : std::size_t { kTimeRole, kInputRole, kOutputRole, kRoleCount };

struct Heading {
    std::string name;  ///< lower case, without unit
    std::string unit;  ///< as written; "" if none
};

/// "PV [degC]", "PV (degC)", "PV / degC", "PV, degC", "time_ms" apart.
Heading split_heading(std::string_view text);

/// How plainly a heading names a role: 1 is its very name ("PV", "time"), with `order` by preference; 2 a tag that ends
/// in one ("TIC101.PV", "TIC101/PID1/OUT.CV", "Temp1"); 3 a name that holds one as a word ("Reactor temperature A").
struct NameMatch {
    int level = 0;
    int order = 0;
};

std::optional<NameMatch> match(const Heading& heading, Role role);

/// Running numbers that exports put in front.
bool is_index(std::string_view heading);

/// Set points, qualities, modes, alarms: never y or u unless chosen.
bool is_beside_the_point(const Heading& heading);

}  // namespace tunewright::api
