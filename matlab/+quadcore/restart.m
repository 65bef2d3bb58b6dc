function row = restart(client, seed)
% RESTART  Begin the flight anew, perhaps with another seed; returns its first row.
  if nargin < 2
    seed = [];
  end
  row = quadcore.request(client, 3, seed);
end
