function row = step(client, speeds, steps)
% STEP  Let the vehicle fly on; returns the row at the end.
%
%   row = quadcore.step(client, speeds)         one step
%   row = quadcore.step(client, speeds, steps)
%   row = quadcore.step(client, [], 0)          the row that is
%
% speeds: signed rotor speeds before the division by sim_slow, rad/s; [] keeps those before.
  if nargin < 3
    steps = 1;
  end
  row = quadcore.request(client, 2, [steps, speeds(:)']);
end
