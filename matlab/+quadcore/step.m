function row = step(client, speeds, steps)
% STEP  Advance the flight and return its last row.
%
%   row = quadcore.step(client, speeds)         one step
%   row = quadcore.step(client, speeds, steps)
%   row = quadcore.step(client, [], 0)          the current row
%
% speeds: signed rotor speeds (rad/s), before the division by sim_slow; [] keeps the last command.
  if nargin < 3
    steps = 1;
  end
  row = quadcore.request(client, 2, [steps, speeds(:)']);
end
