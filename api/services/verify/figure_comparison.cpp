#include "api/services/verify/figure_comparison.h"

#include "engine/verify/tolerance.h"

namespace tunewright::api {

void compare_value(VerifyAnswer& answer, const std::string& where, std::string_view figure, const Json& given,
                   const Json& found, const IndexErrors& stated) {
    VerifiedFigure one{.where = where, .figure = std::string(figure), .given = given, .found = found, .difference = {}};
    if (given.is_number() && found.is_number()) {
        const auto allowed = verify::largest_difference(figure, stated);
        if (!allowed) return;
        one.allowed = *allowed;
        one.difference = verify::difference(figure, given.get<double>(), found.get<double>());
        one.agrees = *one.difference <= one.allowed;
    } else {
        one.agrees = given == found;
    }
    answer.figures.push_back(std::move(one));
}

namespace {

void compare_below(VerifyAnswer& answer, const std::string& where, std::string_view figure, const Json& given,
                   const Json& found, const IndexErrors& stated) {
    if (given.is_object()) {
        for (const auto& [name, value] : given.items())
            if (name != "why_null" && found.is_object() && found.contains(name))
                compare_below(answer, where + "/" + pointer_segment(name), name, value, found.at(name), stated);
    } else if (given.is_array()) {
        for (std::size_t i = 0; i < given.size() && found.is_array() && i < found.size(); ++i)
            compare_below(answer, where + "/" + std::to_string(i), figure, given[i], found[i], stated);
    } else if (!given.is_string()) {
        compare_value(answer, where, figure, given, found, stated);
    }
}

}  // namespace

void compare_figures(VerifyAnswer& answer, const std::string& where, const Json& given, const Json& found,
                     const IndexErrors& stated) {
    compare_below(answer, where, "", given, found, stated);
}

}  // namespace tunewright::api
