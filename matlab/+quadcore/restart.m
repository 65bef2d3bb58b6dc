function row = restart(client, seed)
% RESTART  Restart the flight and return its first row.
%
%   row = quadcore.restart(client)
%   row = quadcore.restart(client, seed)
  if nargin < 2
    seed = [];
  end
  row = quadcore.request(client, 3, seed);
end
