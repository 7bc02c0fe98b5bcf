#include "api/report/terminal/entry_rows.h"

#include <algorithm>

#include "api/json/utf8.h"
#include "api/report/terminal/columns.h"

namespace tunewright::api {
namespace {

constexpr const char* kNoLevel = "-";
constexpr std::size_t kWidestEntryTitle = 44;

std::string text_at(const Json& entry, const char* pointer) {
    const Json value = member_at(entry, pointer);
    return value.is_string() ? value.get<std::string>() : "";
}

}  // namespace

Json member_at(const Json& value, const char* pointer) {
    const Json::json_pointer where(pointer);
    return value.contains(where) ? value.at(where) : Json();
}

std::vector<std::size_t> entry_order(const Json& result) {
    const std::size_t count = result.at("controllers").size();
    std::vector<std::size_t> order;
    for (const Json& place : result.value("ranking", Json::array()))
        if (place.is_number_unsigned() && place.get<std::size_t>() < count) order.push_back(place.get<std::size_t>());
    for (std::size_t i = 0; i < count; ++i)
        if (std::find(order.begin(), order.end(), i) == order.end()) order.push_back(i);
    return order;
}

std::string entry_title(const Json& entry) {
    std::string title = text_at(entry, "/title");
    if (title.empty()) title = text_at(entry, "/method");
    if (letters(title) > kWidestEntryTitle) title = std::string(whole_characters(title, kWidestEntryTitle - 3)) + "...";
    return title;
}

EntryRows entry_rows(const Json& result) {
    EntryRows found;
    for (const std::size_t place : entry_order(result)) {
        const Json& entry = result.at("controllers").at(place);
        if (!entry.contains("controller")) {
            ++found.without_controller;
            continue;
        }
        EntryRow row{place, text_at(entry, "/method"), entry_title(entry), text_at(entry, "/verdict/0/level"), {}};
        if (row.level.empty()) row.level = kNoLevel;
        for (std::size_t i = 0; i < kEntryFigures.size(); ++i)
            row.figures[i] = member_at(entry, kEntryFigures[i].pointer);
        found.rows.push_back(std::move(row));
    }
    return found;
}

}  // namespace tunewright::api
