// The commands that need no service of their own: `tunewright tune`, `identify` and `plant` answer one request,
// `tunewright code` and `report` write a controller of a result, and `tunewright health` asks a running service.
#pragma once

#include <string>

#include "api/code/code.h"
#include "api/service.h"

namespace tunewright::server {

/// Reads a tuning request from the file ("-": standard input). The result goes to standard output and 0 is returned; a
/// problem goes to standard error as problem JSON and 1 is returned.
int tune(const std::string& file);

struct IdentifyCommand {
    std::string file;  ///< "-": standard input
    api::CsvRequest question;
};

/// Reads a CSV file or a log as it is, or a request of POST /v1/identify where the file is one JSON object. The answer
/// goes to standard output and 0 is returned; a problem goes to standard error as problem JSON and 1 is returned. The
/// only limit on the file's size is that of a record, 2,000,000 samples.
int identify(const IdentifyCommand& command);

struct PlantCommand {
    std::string text;  ///< "-": standard input
    std::string time_unit = "s";
};

/// Answers POST /v1/plants/parse of the text to standard output and returns 0; a problem goes to standard error as
/// problem JSON and 1 is returned.
int plant(const PlantCommand& command);

struct CodeCommand {
    std::string file;        ///< a result or a job; "-": standard input
    std::string request;     ///< file of the request that it answers; "": not known
    std::string controller;  ///< its number in the result; "": the best
    api::CodeWords words;    ///< parameters of GET /v1/jobs/{id}/controllers/{index}/code
};

/// Writes the controller as source text to standard output and returns 0; a problem goes to standard error as problem
/// JSON and 1 is returned.
int code(const CodeCommand& command);

struct ReportCommand {
    std::string file;        ///< a result or a job; "-": standard input
    std::string request;     ///< file of the request that it answers; "": not known
    std::string controller;  ///< its number in the result; "": the best
};

/// Writes GET /v1/jobs/{id}/report.html of the result to standard output and returns 0; a problem goes to standard
/// error as problem JSON and 1 is returned.
int report(const ReportCommand& command);

/// GET `url` (http://HOST:PORT/PATH, HOST an address or a name), answered within three seconds. Returns 0 where the
/// status is 200; else 1, and standard error says why. 2 where the url cannot be used.
int check_health(const std::string& url);

/// http://HOST:PORT/healthz for what --listen says; loopback where it says every address.
std::string health_url(const std::string& listen);

}  // namespace tunewright::server
