#include "api/csv/columns/heading.h"

#include <algorithm>
#include <cctype>
#include <iterator>
#include <span>
#include <utility>
#include <vector>

#include "api/csv/cell.h"
#include "api/csv/columns/heading_words.h"
#include "api/csv/text.h"
#include "api/csv/time_stamp.h"

namespace tunewright::api {
namespace {

/// After "y", "pv", "pv_in" and before words that may also name a command, such as "speed".
constexpr int kMeasuredOrder = 2;

bool has_word(const Heading& heading, std::string_view word) {
    return std::find(heading.words.begin(), heading.words.end(), word) != heading.words.end();
}

Heading heading_of(std::string_view whole, std::string_view name, std::string_view unit) {
    name = trimmed(name);
    return {std::string(whole), lower_case(name), std::string(trimmed(unit)), words(name)};
}

// Splits "time_ms", "elapsedMs", "TimeUS": a name of time with its unit.
std::optional<Heading> with_unit_of_time(std::string_view text) {
    const std::vector<std::string> parts = words(text);
    if (parts.size() < 2 || !seconds_per(parts.back())) return std::nullopt;
    if (!place(parts.front(), kTimeRole) || seconds_per(parts.front())) return std::nullopt;
    const std::size_t length = parts.back().size();
    std::string_view name = text.substr(0, text.size() - length);
    while (!name.empty() && (name.back() == '_' || name.back() == ' ' || name.back() == '-' || name.back() == '.'))
        name.remove_suffix(1);
    return heading_of(text, name, lower_case(text.substr(text.size() - length)));
}

bool may_command(const Heading& heading) {
    return has_word(heading, "cmd") || has_word(heading, "command") || has_word(heading, "commanded");
}

bool names_role(const Heading& heading, ColumnRole role) {
    return std::any_of(heading.words.begin(), heading.words.end(),
                       [&](const std::string& word) { return word_place(word, role).has_value(); });
}

/// Matches "SP", "TIC101.SP", "T_set", "setTemp", "targetSpeed", "speed_cmd".
std::optional<NameMatch> reference_match(const Heading& heading) {
    if (const auto at = place(heading.name, kReferenceRole)) return NameMatch{1, *at};
    static constexpr std::string_view kWords[] = {
        "sp",     "spt",     "setpoint", "sollwert", "soll", "consigne", "consigna", "reference", "ref",
        "target", "desired", "setpt",    "wsp",      "lsp",  "rsp",      "csp",      "setvalue"};
    static constexpr std::string_view kHeld[] = {"setpoint", "sollwert", "target", "consigne"};
    const auto& words = heading.words;
    bool found = std::any_of(words.begin(), words.end(), [](const auto& word) { return is_one_of(word, kWords); }) ||
                 std::any_of(std::begin(kHeld), std::end(kHeld),
                             [&](std::string_view held) { return heading.name.find(held) != std::string::npos; });
    if (words.size() > 1 && !names_role(heading, kInputRole)) {
        const std::string& last = words.back();
        found = found || words.front() == "set" || last == "set" || last == "sv" || last == "w" ||
                (may_command(heading) && names_role(heading, kOutputRole));
    }
    for (std::size_t i = 0; i + 1 < words.size(); ++i) found = found || (words[i] == "set" && words[i + 1] == "point");
    return found ? std::optional<NameMatch>(NameMatch{2, 0}) : std::nullopt;
}

constexpr std::string_view kModeWords[] = {"mode", "modus", "modo", "betriebsart"};
constexpr std::string_view kModeStates[] = {"auto", "automatic", "automatik", "man", "manual", "hand"};
constexpr std::string_view kModeLetters[] = {"a", "m", "h"};
constexpr std::string_view kActual[] = {"actual", "act", "ist"};

/// The words of a heading without those that name the mode at its end, and what these are.
struct NamedMode {
    enum What { none, actual_mode, mode, state } what = none;  ///< in the order of preference
    std::vector<std::string> before;
};

NamedMode named_mode(const Heading& heading) {
    // The mode that was asked for or is usual is not the mode.
    static constexpr std::string_view kOther[] = {"target", "normal", "requested", "permitted", "desired"};
    NamedMode named{.what = NamedMode::none, .before = heading.words};
    std::vector<std::string>& words = named.before;
    if (std::ranges::any_of(words, [](const auto& word) { return is_one_of(word, kOther); })) return named;
    // The codes of "Mode 0=MAN 1=AUTO" name nothing, but "Auto=1" does, and so does the 101 of "TIC-101.MODE".
    for (std::string& word : words) word.resize(std::min(word.find('='), word.size()));
    const auto names_mode = [](const auto& word) {
        return is_one_of(word, kModeWords) || is_one_of(word, kModeStates);
    };
    const auto codes = std::remove_if(std::ranges::find_if(words, names_mode), words.end(),
                                      [](const auto& word) { return word.empty() || is_digit(word.front()); });
    words.erase(codes, words.end());
    const auto take_last = [&](const auto& known) {
        const bool has = !words.empty() && is_one_of(words.back(), known);
        if (has) words.pop_back();
        return has;
    };
    bool actual = words.size() > 1 && take_last(kActual);
    if (!actual && words.size() > 1 && is_one_of(words.front(), kActual)) actual = true, words.erase(words.begin());
    if (words.size() > 1 && words.back() == "on") words.pop_back();  // AUTO_ON
    if (take_last(kModeWords)) {
        named.what = actual ? NamedMode::actual_mode : NamedMode::mode;
    } else if (words.size() > 1 && heading.name.find('/') != heading.name.npos && take_last(kModeLetters)) {
        if (take_last(kModeLetters)) named.what = NamedMode::mode;
    } else if (take_last(kModeStates)) {
        named.what = take_last(kModeStates) ? NamedMode::mode : NamedMode::state;
    }
    return named;
}

/// Matches "MODE", "TIC101.MODE.ACTUAL", "A/M", "Hand/Automatik", "TIC101.AUTO".
std::optional<NameMatch> mode_match(const Heading& heading) {
    const NamedMode named = named_mode(heading);
    if (named.what == NamedMode::none) return std::nullopt;
    static constexpr std::string_view kAnyLoop[] = {"loop", "pid", "controller", "control", "in", "is"};
    const bool plain = std::ranges::all_of(named.before, [](const auto& word) { return is_one_of(word, kAnyLoop); });
    return NameMatch{plain ? 1 : 2, named.what};
}

}  // namespace

std::string role_name(ColumnRole role) {
    constexpr std::array<const char*, kRoleCount + 1> kNames = {"t", "u", "y", "r", "mode", "d"};
    return kNames.at(role);
}

std::string role_meaning(ColumnRole role) {
    constexpr std::array<const char*, kRoleCount + 1> kMeanings = {
        "time",          "the controller output", "the measurement",
        "the set point", "the mode of the loop",  "a measured disturbance"};
    return kMeanings.at(role);
}

Heading split_heading(std::string_view text) {
    text = trimmed(text);
    for (const auto& [open, close] : {std::pair{'[', ']'}, std::pair{'(', ')'}}) {
        const std::size_t start = text.rfind(open);
        if (start != text.npos && start > 0 && text.back() == close) {
            return heading_of(text, text.substr(0, start), text.substr(start + 1, text.size() - start - 2));
        }
    }
    for (const std::string_view between : {" / ", " in ", ", "}) {
        const std::size_t at = text.rfind(between);
        if (at != text.npos && at > 0) return heading_of(text, text.substr(0, at), text.substr(at + between.size()));
    }
    if (auto timed = with_unit_of_time(text)) return *std::move(timed);
    return heading_of(text, text, {});
}

std::optional<NameMatch> match(const Heading& heading, ColumnRole role) {
    if (role == kReferenceRole) return reference_match(heading);
    if (role == kModeRole) return mode_match(heading);
    // A capital T is more likely a temperature than a time.
    constexpr int kLast = 1000;
    if (heading.name == "t" && heading.text.front() == 'T') {
        if (role == kTimeRole) return NameMatch{1, kLast};
        if (role == kOutputRole) return NameMatch{2, kLast};
    }
    if (const auto at = place(heading.name, role)) return NameMatch{1, *at};
    if (role == kOutputRole && is_measured(heading)) return NameMatch{1, kMeasuredOrder};
    std::vector<std::string> parts = heading.words;
    if (parts.empty()) return std::nullopt;
    // The current value of a parameter, as in PID1/OUT.CV.
    if (parts.size() > 1 && (parts.back() == "cv" || parts.back() == "value" || parts.back() == "val") &&
        (word_place(parts[parts.size() - 2], kInputRole) || word_place(parts[parts.size() - 2], kOutputRole)))
        parts.pop_back();
    // The command of a named actuator is its output: "valve cmd".
    if (parts.size() > 1 && role == kInputRole && (parts.back() == "cmd" || parts.back() == "command") &&
        word_place(parts[parts.size() - 2], kInputRole))
        parts.pop_back();
    if (role == kInputRole && is_state(heading) && parts.size() > 1) {
        const auto at = place(parts[parts.size() - 2], role);
        return at ? std::optional<NameMatch>(NameMatch{3, *at}) : std::nullopt;
    }
    if (const auto at = word_place(parts.back(), role)) {
        bool other = false;
        for (const ColumnRole rival : {kInputRole, kOutputRole}) {
            for (std::size_t i = 0; i + 1 < parts.size() && heading.name.find(' ') != heading.name.npos; ++i)
                other = other || (rival != role && role != kTimeRole && word_place(parts[i], rival));
        }
        return other ? std::nullopt : std::optional<NameMatch>(NameMatch{2, *at});
    }
    std::optional<int> held;
    for (const std::string& word : parts) {
        if (role != kTimeRole && word_place(word, role == kInputRole ? kOutputRole : kInputRole)) return std::nullopt;
        if (const auto at = word_place(word, role); at && !held) held = at;
    }
    if (!held) return std::nullopt;
    return NameMatch{3, *held};
}

bool is_measured(const Heading& heading) {
    static constexpr std::string_view kMeasured[] = {"measured", "actual", "act", "ist", "meas", "gemessen", "real"};
    if (heading.words.size() < 2 || names_role(heading, kInputRole)) return false;
    return std::any_of(heading.words.begin(), heading.words.end(),
                       [](const std::string& word) { return is_one_of(word, kMeasured); });
}

bool is_command(const Heading& heading) {
    return may_command(heading) && !names_role(heading, kInputRole) && !names_role(heading, kOutputRole);
}

bool is_index(std::string_view heading) {
    const std::string name = lower_case(trimmed(heading));
    return name.empty() || name == "index" || name == "#" || name == "no" || name == "no." || name == "nr" ||
           name == "nr." || name == "row" || name == "sample" || name == "id" || name == "samples" ||
           name == "sample number" || name == "record" || name.rfind("unnamed:", 0) == 0;
}

bool is_spacing(const Heading& heading) {
    static constexpr std::string_view kNames[] = {"ts",
                                                  "dt",
                                                  "sample time",
                                                  "sampling time",
                                                  "sample_time",
                                                  "sampling_time",
                                                  "sample period",
                                                  "sampling period",
                                                  "sampling interval",
                                                  "tsample",
                                                  "t_s",
                                                  "delta t",
                                                  "deltat",
                                                  "abtastzeit"};
    return is_one_of(heading.name, kNames);
}

bool is_frequency(const Heading& heading) {
    static constexpr std::string_view kNames[] = {
        "fs",          "sample rate",    "sampling rate",      "samplerate",       "sampling frequency",
        "sample_rate", "sampling_rate",  "sampling_frequency", "sample frequency", "abtastrate",
        "f_s",         "abtastfrequenz", "sample_frequency"};
    return is_one_of(heading.name, kNames);
}

bool is_percent(const Heading& heading) {
    static constexpr std::string_view kWords[] = {"percent", "pct", "perc", "prozent", "pourcent", "percentage", "%"};
    if (heading.unit == "%" || (!heading.text.empty() && heading.text.back() == '%')) return true;
    return is_one_of(lower_case(heading.unit), kWords) ||
           std::any_of(heading.words.begin(), heading.words.end(),
                       [](const std::string& word) { return is_one_of(word, kWords); });
}

bool is_never_input(const Heading& heading) {
    static constexpr std::string_view kWords[] = {"linkquality",
                                                  "rssi",
                                                  "lqi",
                                                  "snr",
                                                  "strength",
                                                  "battery",
                                                  "batt",
                                                  "vbat",
                                                  "vbatt",
                                                  "vcc",
                                                  "humidity",
                                                  "rh",
                                                  "illuminance",
                                                  "lux",
                                                  "co2",
                                                  "voc",
                                                  "pm25",
                                                  "dewpoint",
                                                  "barometer",
                                                  "uptime",
                                                  "heap",
                                                  "freeheap",
                                                  "firmware",
                                                  "retries",
                                                  "seq",
                                                  "sequence",
                                                  "linkqual",
                                                  "quality",
                                                  "weather",
                                                  "feuchte",
                                                  "luftfeuchte",
                                                  "luftfeuchtigkeit",
                                                  "batterie",
                                                  "humedad",
                                                  "humidit\xC3\xA9",
                                                  "umidit\xC3\xA0"};
    return std::any_of(heading.words.begin(), heading.words.end(),
                       [](const std::string& word) { return is_one_of(word, kWords); });
}

bool is_state(const Heading& heading) {
    return !heading.words.empty() && (heading.words.back() == "state" || heading.words.back() == "status");
}

bool is_term_letter(const Heading& heading) {
    return heading.name == "p" || heading.name == "i" || heading.name == "d";
}

bool is_controller_term(const Heading& heading, bool with_letters) {
    static constexpr std::string_view kTerms[] = {"e",
                                                  "error",
                                                  "err",
                                                  "fehler",
                                                  "regelabweichung",
                                                  "deviation",
                                                  "erreur",
                                                  "e(t)",
                                                  "proportional",
                                                  "integral",
                                                  "derivative",
                                                  "pterm",
                                                  "iterm",
                                                  "dterm",
                                                  "integrator",
                                                  "control error",
                                                  "kp",
                                                  "ki",
                                                  "kd"};
    if (is_one_of(heading.name, kTerms)) return true;
    if (is_term_letter(heading)) return with_letters;
    const auto& words = heading.words;
    if (words.size() < 2) return false;
    static constexpr std::string_view kParts[] = {"term", "part", "component", "action", "contribution", "anteil"};
    static constexpr std::string_view kWhich[] = {"p", "i", "d", "proportional", "integral", "derivative"};
    for (std::size_t i = 0; i + 1 < words.size(); ++i) {
        if (is_one_of(words[i], kWhich) && is_one_of(words[i + 1], kParts)) return true;
        if ((words[i] == "pid" || words[i] == "control") && is_one_of(words[i + 1], kWhich)) return true;
    }
    return words.back() == "error" || words.back() == "err";
}

std::string stem(const Heading& heading) {
    std::vector<std::string> parts = heading.words;
    const auto names_role = [](const std::string& word) {
        return word_place(word, kInputRole) || word_place(word, kOutputRole) || place(word, kReferenceRole) ||
               word == "cv" || word == "val";
    };
    while (parts.size() > 1 && names_role(parts.back())) parts.pop_back();
    if (parts.size() == heading.words.size()) return {};
    std::string out;
    for (const std::string& part : parts) out += part + " ";
    return out;
}

std::string mode_stem(const Heading& heading) {
    std::string out;
    for (const std::string& part : named_mode(heading).before) out += part + " ";
    return out;
}

std::string number_behind(const Heading& heading) {
    if (heading.words.empty()) return {};
    const std::string& last = heading.words.back();
    const std::size_t at = last.find_last_not_of("0123456789");
    return at == last.npos ? last : last.substr(at + 1);
}

bool is_auxiliary(const Heading& heading) {
    static constexpr std::string_view kBeside[] = {
        "quality", "status", "mode",   "alarm", "validity", "qual", "comment",     "outside", "outdoor", "ambient",
        "event",   "auto",   "manual", "state", "flag",     "spt",  "linkquality", "rssi",    "lqi",     "snr"};
    if (match(heading, kReferenceRole) || match(heading, kModeRole)) return true;
    return std::any_of(heading.words.begin(), heading.words.end(),
                       [](const std::string& word) { return is_one_of(word, kBeside); });
}

}  // namespace tunewright::api
