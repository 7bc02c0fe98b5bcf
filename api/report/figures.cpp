#include "api/report/figures.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/number_text.h"

namespace tunewright::api {
namespace {

std::string true_minus(std::string text) {
    if (!text.empty() && text[0] == '-') text = "−" + text.substr(1);
    const std::size_t exponent = text.find("e-");
    if (exponent != std::string::npos) text = text.substr(0, exponent + 1) + "−" + text.substr(exponent + 2);
    return text;
}

}  // namespace

std::string number_text(double value, int digits) { return true_minus(tunewright::text(value, digits)); }

Html figure(const JsonLocation& place, int digits) {
    const Json& value = place.value();
    if (value.is_number())
        return element("span", number_text(value.get<double>(), digits), {{"data-at", place.pointer}});
    return element("span", "–", {{"title", why_null(place)}});
}

std::string why_null(const JsonLocation& place) {
    const std::size_t slash = place.pointer.rfind('/');
    return text_at({place.root, place.pointer.substr(0, slash) + "/why_null" + place.pointer.substr(slash)});
}

bool negligible(double standard_error, double value) {
    constexpr double kMinRelativeError = 1e-6;
    return !(standard_error > kMinRelativeError * std::abs(value));
}

std::string uncertain_text(double value, double standard_error) {
    const std::string alone = tunewright::text(value);
    return negligible(standard_error, value) ? alone : alone + " +- " + figure_text(standard_error, 2);
}

std::string grade_words(std::string_view grade, std::string_view reason) {
    if (grade == "good") return "A good model.";
    if (grade == "usable") return "Use the model with care: see its warnings.";
    if (grade != "doubtful") return "";
    if (reason == "fit") return "A doubtful model: it explains too little of its record.";
    return reason == "warning" ? "A doubtful model: see its warnings." : "A doubtful model.";
}

bool any_has(const std::vector<JsonLocation>& places, const std::string& name) {
    return std::ranges::any_of(
        places, [&](const JsonLocation& one) { return one.value().is_object() && one.value().contains(name); });
}

Html table(const char* caption, const Row& heads, const std::vector<Row>& rows) {
    Html head, body;
    for (const Html& cell : heads) head += cell.empty() ? element("td", "") : element("th", cell, {{"scope", "col"}});
    for (const Row& row : rows) {
        Html cells;
        for (std::size_t i = 0; i < row.size(); ++i)
            cells += i == 0 ? element("th", row[i], {{"scope", "row"}}) : element("td", row[i]);
        body += element("tr", cells);
    }
    return element("table",
                   element("caption", caption) + element("thead", element("tr", head)) + element("tbody", body));
}

Html list(const std::vector<Html>& items) {
    Html out;
    for (const Html& item : items) out += element("li", item);
    return out.empty() ? out : element("ul", out);
}

Html section(const char* title, const Html& inside) {
    if (inside.empty()) return {};
    return element("section", element("h2", title) + inside);
}

std::string unit_quotient(const std::string& above, const std::string& below) {
    if (above.empty() || below.empty()) return "";
    return above == below ? "" : above + "/" + below;
}

std::string with_unit(const std::string& name, const std::string& unit) {
    return unit.empty() ? name : name + " (" + unit + ")";
}

}  // namespace tunewright::api
