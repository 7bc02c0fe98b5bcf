#include "api/report/figures.h"

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

std::string tick_text(double value) { return true_minus(tunewright::text(std::abs(value) < 1e-300 ? 0 : value, 6)); }

Html figure(const Place& place, int digits) {
    const Json& value = place.value();
    if (value.is_number())
        return element("span", number_text(value.get<double>(), digits), {{"data-at", place.pointer}});
    const std::size_t slash = place.pointer.rfind('/');
    const Place owner{place.root, place.pointer.substr(0, slash) + "/why_null" + place.pointer.substr(slash)};
    const std::string why = text_at(owner);
    return element("span", "–", {{"title", why}});
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
