function client = connect(port)
% CONNECT  Drive a flight that `quadcore serve` holds ready on this machine.
%
%   client = quadcore.connect(5005)
%
% client.dt is the length of a step (s), client.rotors how many numbers a command has, and
% client.columns a cell array of the names of a row's numbers. Octave needs its package
% instrument-control, MATLAB nothing. `clear client` ends the flight.
  if exist('OCTAVE_VERSION', 'builtin')
    pkg('load', 'instrument-control');
  end
  client.socket = tcpclient('127.0.0.1', port);
  hello = quadcore.request(client, 0, 1);
  client.dt = hello(2);
  client.rotors = hello(3);
  client.columns = strsplit(char(quadcore.request(client, 1, [])), ',');
end
