#include "server/routes/parameters.h"

#include "api/csv/encoding.h"
#include "api/json/parse.h"
#include "server/http/problems.h"

namespace tunewright::server {

api::Problem bad_parameters(const char* of) {
    return http::problem(422, std::string("The parameters of the ") + of + " are not valid.");
}

void refuse_parameter(api::Problem& problem, const std::string& name, const std::string& value,
                      const std::string& rule) {
    std::string name_storage, value_storage;
    const std::string shown_name(api::utf8_text(name, name_storage));
    problem.errors.push_back({"/" + api::pointer_segment(shown_name),
                              shown_name + " is \"" +
                                  std::string(api::utf8_text(std::string_view(value).substr(0, 64), value_storage)) +
                                  "\"; " + rule});
}

}  // namespace tunewright::server
