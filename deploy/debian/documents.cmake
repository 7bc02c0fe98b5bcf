# Run by the installation, with `program` and `documents` set: the manual page and what shells complete come from the
# binary itself, which knows its commands and options.
file(MAKE_DIRECTORY "${documents}")
function(tunewright_says file)
  execute_process(COMMAND ${program} ${ARGN} OUTPUT_FILE "${documents}/${file}" COMMAND_ERROR_IS_FATAL ANY)
endfunction()
tunewright_says(tunewright.1 manual)
tunewright_says(tunewright completion bash)
tunewright_says(_tunewright completion zsh)
execute_process(COMMAND gzip -9nf "${documents}/tunewright.1" COMMAND_ERROR_IS_FATAL ANY)
