#include "api/csv/heading.h"

#include <algorithm>
#include <cctype>
#include <span>
#include <utility>
#include <vector>

#include "api/csv/cell.h"
#include "api/csv/time_stamp.h"

namespace tunewright::api {
namespace {

// In the order of preference; several languages, several makers' conventions.
constexpr std::array<std::string_view, 32> kTimeNames = {
    "t",           "time",       "timestamp", "date time",  "datetime",      "date_time",
    "time stamp",  "time_stamp", "t_stamp",   "date/time",  "date & time",   "timestring",
    "date",        "seconds",    "sec",       "elapsed",    "elapsed time",  "zeit",
    "zeitstempel", "uhrzeit",    "datum",     "datum/zeit", "temps",         "tiempo",
    "tempo",       "tijd",       "tid",       "x_value",    "relative time", "sample time",
    "fecha",       "time_ms"};
constexpr std::array<std::string_view, 48> kInputNames = {"u",
                                                          "op",
                                                          "mv",
                                                          "co",
                                                          "out",
                                                          "output",
                                                          "controller output",
                                                          "controlleroutput",
                                                          "control output",
                                                          "manipulated variable",
                                                          "cv",
                                                          "lmn",
                                                          "cveu",
                                                          "cvout",
                                                          "input",
                                                          "valve",
                                                          "valve position",
                                                          "heater",
                                                          "heater power",
                                                          "power",
                                                          "duty",
                                                          "pwm",
                                                          "stellgr\xC3\xB6\xC3\x9F"
                                                          "e",
                                                          "stellgroesse",
                                                          "stellwert",
                                                          "ventil",
                                                          "heizung",
                                                          "heizleistung",
                                                          "ausgang",
                                                          "commande",
                                                          "sortie",
                                                          "vanne",
                                                          "salida",
                                                          "valvula",
                                                          "v\xC3\xA1lvula",
                                                          "uscita",
                                                          "valvola",
                                                          "klep",
                                                          "y_out",
                                                          "control",
                                                          "u(t)",
                                                          "actuator",
                                                          "pump",
                                                          "damper",
                                                          "fan",
                                                          "q",
                                                          "q1",
                                                          "dac"};
constexpr std::array<std::string_view, 44> kOutputNames = {"y",
                                                           "pv",
                                                           "pv_in",
                                                           "temp",
                                                           "temperature",
                                                           "measurement",
                                                           "process value",
                                                           "process variable",
                                                           "processvalue",
                                                           "processvariable",
                                                           "measured",
                                                           "measured value",
                                                           "value",
                                                           "mess",
                                                           "istwert",
                                                           "messwert",
                                                           "regelgr\xC3\xB6\xC3\x9F"
                                                           "e",
                                                           "regelgroesse",
                                                           "level",
                                                           "flow",
                                                           "pressure",
                                                           "speed",
                                                           "position",
                                                           "ph",
                                                           "concentration",
                                                           "temperatur",
                                                           "druck",
                                                           "durchfluss",
                                                           "f\xC3\xBCllstand",
                                                           "niveau",
                                                           "mesure",
                                                           "temp\xC3\xA9rature",
                                                           "temperatura",
                                                           "medida",
                                                           "misura",
                                                           "meting",
                                                           "sensor",
                                                           "thermocouple",
                                                           "y(t)",
                                                           "response",
                                                           "rpm",
                                                           "t1",
                                                           "pv1",
                                                           "adc"};

std::span<const std::string_view> names(Role role) {
    if (role == kTimeRole) return kTimeNames;
    return role == kInputRole ? std::span<const std::string_view>(kInputNames)
                              : std::span<const std::string_view>(kOutputNames);
}

std::optional<int> place(std::string_view name, Role role) {
    const auto all = names(role);
    const auto found = std::find(all.begin(), all.end(), name);
    if (found == all.end()) return std::nullopt;
    return static_cast<int>(found - all.begin());
}

std::vector<std::string_view> words(std::string_view name) {
    constexpr std::string_view kBetween = " ._-/\\:!|[]()";
    std::vector<std::string_view> out;
    for (std::size_t at = 0; at < name.size();) {
        const std::size_t start = name.find_first_not_of(kBetween, at);
        if (start == name.npos) break;
        at = std::min(name.find_first_of(kBetween, start), name.size());
        out.push_back(name.substr(start, at - start));
    }
    return out;
}

// "pv1" -> "pv"; single letters say too little.
std::optional<int> word_place(std::string_view word, Role role) {
    constexpr std::size_t kShortest = 2;
    if (word.size() >= kShortest) {
        if (const auto at = place(word, role)) return at;
    }
    while (!word.empty() && std::isdigit(static_cast<unsigned char>(word.back()))) word.remove_suffix(1);
    return word.size() >= kShortest ? place(word, role) : std::nullopt;
}

}  // namespace

Heading split_heading(std::string_view text) {
    text = trimmed(text);
    for (const auto& [open, close] : {std::pair{'[', ']'}, std::pair{'(', ')'}}) {
        const std::size_t start = text.rfind(open);
        if (start != text.npos && start > 0 && text.back() == close) {
            return {lower_case(trimmed(text.substr(0, start))),
                    std::string(trimmed(text.substr(start + 1, text.size() - start - 2)))};
        }
    }
    for (const std::string_view between : {" / ", " in ", ", "}) {
        const std::size_t at = text.rfind(between);
        if (at != text.npos && at > 0)
            return {lower_case(trimmed(text.substr(0, at))), std::string(trimmed(text.substr(at + between.size())))};
    }
    if (const std::size_t underscore = text.rfind('_');
        underscore != text.npos && underscore > 0 && seconds_per(text.substr(underscore + 1))) {
        const std::string stem = lower_case(text.substr(0, underscore));
        if (stem == "t" || stem == "time") return {stem, std::string(text.substr(underscore + 1))};
    }
    return {lower_case(text), {}};
}

std::optional<NameMatch> match(const Heading& heading, Role role) {
    if (const auto at = place(heading.name, role)) return NameMatch{1, *at};
    std::vector<std::string_view> parts = words(heading.name);
    if (parts.empty()) return std::nullopt;
    // The parameter's own current value, as in PID1/OUT.CV.
    if (parts.size() > 1 && (parts.back() == "cv" || parts.back() == "value" || parts.back() == "val") &&
        (word_place(parts[parts.size() - 2], kInputRole) || word_place(parts[parts.size() - 2], kOutputRole)))
        parts.pop_back();
    if (const auto at = word_place(parts.back(), role)) {
        bool other = false;
        for (const Role rival : {kInputRole, kOutputRole}) {
            for (std::size_t i = 0; i + 1 < parts.size() && heading.name.find(' ') != heading.name.npos; ++i)
                other = other || (rival != role && role != kTimeRole && word_place(parts[i], rival));
        }
        return other ? std::nullopt : std::optional<NameMatch>(NameMatch{2, *at});
    }
    std::optional<int> held;
    for (const std::string_view word : parts) {
        if (role != kTimeRole && word_place(word, role == kInputRole ? kOutputRole : kInputRole)) return std::nullopt;
        if (const auto at = word_place(word, role); at && !held) held = at;
    }
    if (!held) return std::nullopt;
    return NameMatch{3, *held};
}

bool is_index(std::string_view heading) {
    const std::string name = lower_case(trimmed(heading));
    return name.empty() || name == "index" || name == "#" || name == "no" || name == "no." || name == "nr" ||
           name == "nr." || name == "row" || name == "sample" || name == "id" || name.rfind("unnamed:", 0) == 0;
}

bool is_beside_the_point(const Heading& heading) {
    static constexpr std::array<std::string_view, 22> kBeside = {
        "sp",     "setpoint", "set_point", "sollwert", "consigne", "reference", "ref",   "quality",
        "status", "mode",     "alarm",     "validity", "qual",     "comment",   "event", "auto",
        "manual", "state",    "flag",      "spt",      "target",   "w"};
    if (heading.name == "set point" || heading.name == "r") return true;
    const std::vector<std::string_view> parts = words(heading.name);
    return std::any_of(parts.begin(), parts.end(), [](std::string_view word) {
        return std::find(kBeside.begin(), kBeside.end(), word) != kBeside.end();
    });
}

}  // namespace tunewright::api
