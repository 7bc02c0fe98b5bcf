#include "api/csv/columns/heading_words.h"

#include <algorithm>
#include <cctype>
#include <span>

namespace tunewright::api {
namespace {

// In the order of preference; several languages and makers' conventions.
constexpr std::string_view kTimeNames[] = {"t",
                                           "time",
                                           "timestamp",
                                           "date time",
                                           "datetime",
                                           "date_time",
                                           "time stamp",
                                           "time_stamp",
                                           "t_stamp",
                                           "date/time",
                                           "date & time",
                                           "timestring",
                                           "date",
                                           "seconds",
                                           "sec",
                                           "elapsed",
                                           "elapsed time",
                                           "elapsed_time",
                                           "zeit",
                                           "zeitstempel",
                                           "uhrzeit",
                                           "datum",
                                           "datum/zeit",
                                           "temps",
                                           "tiempo",
                                           "tempo",
                                           "tijd",
                                           "tid",
                                           "x_value",
                                           "relative time",
                                           "sample time",
                                           "fecha",
                                           "time_ms",
                                           "millis",
                                           "millis()",
                                           "ms",
                                           "milliseconds",
                                           "micros",
                                           "minutes",
                                           "min",
                                           "hours",
                                           "uptime",
                                           "clock",
                                           "_time",
                                           "ts",
                                           "epoch",
                                           "unix time",
                                           "unixtime",
                                           "last_changed",
                                           "last_updated",
                                           "created_at",
                                           "recorded_at",
                                           "date/heure",
                                           "horodatage",
                                           "hora",
                                           "fecha y hora",
                                           "fecha/hora",
                                           "data/ora",
                                           "local time",
                                           "time(t)",
                                           "logged at"};
constexpr std::string_view kInputNames[] = {"u",
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
                                            "stellgr\u00f6\u00dfe",
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
                                            "dac",
                                            "duty cycle",
                                            "dutycycle",
                                            "duty_cycle",
                                            "control signal",
                                            "control_signal",
                                            "control effort",
                                            "control value",
                                            "pid output",
                                            "pid_output",
                                            "pidout",
                                            "effort",
                                            "throttle",
                                            "voltage",
                                            "voltaje",
                                            "spannung",
                                            "heat",
                                            "heating",
                                            "cooling",
                                            "burner",
                                            "compressor",
                                            "relay",
                                            "ssr",
                                            "boiler",
                                            "motor",
                                            "puissance",
                                            "potencia",
                                            "calentador",
                                            "bomba",
                                            "pompe",
                                            "stellsignal",
                                            "stellgrad",
                                            "q2",
                                            "heater output"};
constexpr std::string_view kOutputNames[] = {"y",
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
                                             "regelgr\u00f6\u00dfe",
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
                                             "adc",
                                             "actual",
                                             "actual value",
                                             "ist",
                                             "velocity",
                                             "velocidad",
                                             "vitesse",
                                             "drehzahl",
                                             "geschwindigkeit",
                                             "velocit\xC3\xA0",
                                             "angle",
                                             "height",
                                             "humidity",
                                             "presi\xC3\xB3n",
                                             "presion",
                                             "nivel",
                                             "caudal",
                                             "pression",
                                             "d\u00e9bit",
                                             "thermistor",
                                             "temp1",
                                             "t2",
                                             "pv2",
                                             "process_value",
                                             "process_variable",
                                             "feedback",
                                             "distance",
                                             "encoder"};
constexpr std::string_view kReferenceNames[] = {"r",          "sp",           "setpoint",
                                                "set point",  "set_point",    "set-point",
                                                "target",     "sollwert",     "soll",
                                                "consigne",   "reference",    "ref",
                                                "w",          "consigna",     "set value",
                                                "setvalue",   "target value", "setpt",
                                                "spt",        "sv",           "sp_in",
                                                "wsp",        "lsp",          "rsp",
                                                "csp",        "desired",      "desired value",
                                                "referencia", "riferimento",  "f\u00fchrungsgr\u00f6\u00dfe",
                                                "r(t)",       "w(t)",         "punto de consigna",
                                                "y_ref",      "ysp",          "y_sp"};

std::span<const std::string_view> names(ColumnRole role) {
    switch (role) {
        case kTimeRole: return kTimeNames;
        case kInputRole: return kInputNames;
        case kOutputRole: return kOutputNames;
        default: return kReferenceNames;
    }
}

}  // namespace

std::optional<int> place(std::string_view name, ColumnRole role) {
    const auto all = names(role);
    const auto found = std::find(all.begin(), all.end(), name);
    if (found == all.end()) return std::nullopt;
    return static_cast<int>(found - all.begin());
}

// In "heater_bed targetTemp" a word also begins where a capital letter follows a small one.
std::vector<std::string> words(std::string_view text) {
    constexpr std::string_view kBetween = " ._-/\\:!|[]()<>'";
    std::vector<std::string> out;
    bool small = false, open = false;
    for (const char c : text) {
        const auto byte = static_cast<unsigned char>(c);
        const bool between = kBetween.find(c) != kBetween.npos;
        if (between || (small && std::isupper(byte))) open = false;
        small = std::islower(byte) != 0;
        if (between) continue;
        if (!open) out.emplace_back();
        open = true;
        out.back() += static_cast<char>(std::tolower(byte));
    }
    return out;
}

// "pv1" counts as "pv". Single letters are ambiguous, and a word next to others may name another quantity: motor speed,
// cooling water temperature.
std::optional<int> word_place(std::string_view word, ColumnRole role) {
    static constexpr std::string_view kOnlyAlone[] = {"heat", "heating", "cooling", "burner", "compressor", "relay",
                                                      "ssr",  "boiler",  "motor",   "bomba",  "pompe",      "voltage",
                                                      "min",  "ms",      "clock",   "hours",  "feedback",   "actual",
                                                      "ist",  "encoder", "ts",      "epoch"};
    if (is_one_of(word, kOnlyAlone)) return std::nullopt;
    constexpr std::size_t kShortest = 2;
    if (word.size() >= kShortest) {
        if (const auto at = place(word, role)) return at;
    }
    while (!word.empty() && std::isdigit(static_cast<unsigned char>(word.back()))) word.remove_suffix(1);
    return word.size() >= kShortest ? place(word, role) : std::nullopt;
}

}  // namespace tunewright::api
