// The whole request, which can be run again from the print.
#include <algorithm>

#include "api/json/digest.h"
#include "api/json/json.h"
#include "api/json/utf8.h"
#include "api/report/figures.h"
#include "api/report/sections.h"

namespace tunewright::api {
namespace {

constexpr std::size_t kMaxPrinted = 12'000;  ///< bytes; long values of a longer request are cut in print
constexpr std::size_t kMaxItems = 20, kMaxTextLength = 400;

/// Cuts long lists and texts; words state how much was cut.
Json shortened(const Json& value) {
    if (value.is_string() && value.get_ref<const std::string&>().size() > kMaxTextLength) {
        const auto& text = value.get_ref<const std::string&>();
        return std::string(whole_characters(text, kMaxTextLength)) + "... (" + std::to_string(text.size()) + " bytes)";
    }
    if (value.is_array()) {
        Json out = Json::array();
        for (std::size_t i = 0; i < std::min(value.size(), kMaxItems); ++i) out.push_back(shortened(value[i]));
        if (value.size() > kMaxItems) out.push_back("... (" + std::to_string(value.size()) + " in all)");
        return out;
    }
    if (!value.is_object()) return value;
    Json out = Json::object();
    for (const auto& [name, member] : value.items()) out[name] = shortened(member);
    return out;
}

/// The text in quotes for a POSIX shell.
std::string quoted(const std::string& text) {
    std::string out = "'";
    for (const char c : text) out += c == '\'' ? "'\\''" : std::string(1, c);
    return out + "'";
}

}  // namespace

Html request_section(const Json& request, const std::string& origin) {
    if (!request.is_object()) return {};
    const std::string whole = request.dump();
    const bool printed = whole.size() <= kMaxPrinted;
    const std::string call = "curl -sS " + quoted((origin.empty() ? "http://127.0.0.1:8080" : origin) + "/v1/jobs") +
                             " -H 'Content-Type: application/json' -H 'Prefer: wait=60' -d ";
    Html out =
        element("p", "Sending this request again gives the same result.") +
        element("p",
                element("a", "Save the request as a file",
                        {{"download", "request.json"}, {"href", "data:application/json;base64," + base64(whole)}}),
                {{"class", "screen"}});
    if (!printed) out += element("p", "Long lists and texts are shortened here; the file in this page is complete.");
    out += element("pre", (printed ? request : shortened(request)).dump(2), {{"id", "request"}});
    out += element("h3", "As one command") +
           element("pre", call + (printed ? quoted(whole) : "@request.json"), {{"id", "command"}});
    return element("section", element("h2", "Request") + out, {{"class", "request"}});
}

}  // namespace tunewright::api
