function client = connect(port)
% CONNECT  Connect to a vehicle of `quadcore serve` on this computer.
%
%   client = quadcore.connect(5005)
%
% client.dt is the length of a step (s). client.rotors is the number of speeds in a command.
% client.columns is a cell array with the column names of a row. `clear client` ends the flight.
% Octave needs its package instrument-control; MATLAB needs no toolbox.
  if exist('OCTAVE_VERSION', 'builtin')
    pkg('load', 'instrument-control');
  end
  client.socket = tcpclient('127.0.0.1', port);
  hello = quadcore.request(client, 0, 1);
  client.dt = hello(2);
  client.rotors = hello(3);
  client.columns = strsplit(char(quadcore.request(client, 1, [])), ',');
end
