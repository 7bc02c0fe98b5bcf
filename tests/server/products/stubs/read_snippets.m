% octave-cli read_snippets.m REQUEST.json runs each text of the request and prints a list of what each leaves: the
% response of C at the angular frequencies, the parameters that set_param was given, or the error. `loaded` says whether
% a text finds the package control loaded, as a text for MATLAB expects.
1;

function set_param (block, varargin)
  global parameters
  if (! ischar (block) || mod (numel (varargin), 2) || ! iscellstr (varargin))
    error ("set_param: a block and pairs of texts are needed");
  endif
  for pair = reshape (varargin, 2, [])
    if (isfield (parameters, pair{1}))
      error ("set_param: %s is given twice", pair{1});
    endif
    parameters.(pair{1}) = pair{2};
  endfor
endfunction

function found = read (text, frequencies)
  global parameters
  parameters = struct ();
  block = "model/PID Controller";
  try
    eval (text);
    found.parameters = parameters;
    if (exist ("C", "var"))
      response = freqresp (C, frequencies)(:);
      found.real = real (response);
      found.imaginary = imag (response);
    endif
  catch failure
    found = struct ("error", failure.message);
  end_try_catch
endfunction

warning ("off", "all");
input = jsondecode (fileread (argv (){end}));
found = cell (size (input.texts));
for i = 1:numel (input.texts)
  if (input.loaded(i))
    pkg load control
  else
    pkg unload control
  endif
  found{i} = read (input.texts{i}, input.frequencies);
endfor
printf ("%s\n", jsonencode (found));
