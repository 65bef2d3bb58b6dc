% FLY_SPIRAL  Follow the spiral of thesis eq. (6.1) with the PID cascade of section 6.2, in lockstep.
%
% Start the server in a shell first:
%
%   quadcore info quadrotor --vehicle vehicle.mat
%   quadcore serve quadrotor --spawn 2,0,10 --port 5005
%
% You may set port, seconds and vehicle (the file) before. Afterwards, log contains the rows.
addpath(fullfile(fileparts(mfilename('fullpath')), '..'));
if ~exist('port', 'var'), port = 5005; end
if ~exist('seconds', 'var'), seconds = 30; end
if ~exist('vehicle', 'var'), vehicle = 'vehicle.mat'; end

v = load(vehicle);
v.spins = [1, -1, 1, -1];
gains = quadcore.pid_gains();
client = quadcore.connect(port);
row = quadcore.step(client, [], 0);
memory = [];
log = zeros(round(seconds / client.dt) + 1, numel(row));
log(1, :) = row;
for i = 2:size(log, 1)
  t = row(1);
  a = 0.5 * t;
  wanted.position = [2 * cos(a); 2 * sin(a); 10 + t];
  wanted.velocity = [-sin(a); cos(a); 1];
  wanted.acceleration = 0.5 * [-cos(a); -sin(a); 0];
  wanted.yaw = 0;
  wanted.yaw_rate = 0;
  [speeds, memory] = quadcore.pid(v, gains, client.dt, row, wanted, memory);
  row = quadcore.step(client, speeds);
  log(i, :) = row;
end
clear client  % closes the connection
